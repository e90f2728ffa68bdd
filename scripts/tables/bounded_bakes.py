#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bakes landscapes of 1 to 100 km2 with and without a bound of memory: peak, time, and whether the bytes are the same.

scripts/results bounded_bakes [--areas KM2 ...] [--cell M]: built-in landscapes with air and nodes; without a bound, with 1000 MiB and with 200.
Areas above 16 km2 are baked once, with 1000 MiB. Needs 0.1 GB of disk for a km2."""
import argparse
import hashlib
import json
import os
import pathlib
import sys
import tempfile

from results_page import ROOT, machine, say, table, write_between

THRONG = ROOT / "build/release/throng"
SLACK = 64 << 20  # beyond the bound [bytes]
LARGE = 16  # [km2]


def bake(area, bound, cell, world):
    """The report of a bake and its peak of memory [bytes]; exits if it fails."""
    side = round(1000 * area**0.5)
    command = [str(THRONG), "bake", f"builtin:landscape,size={side}", "--fly", "--nodes", "--cell", str(cell), "-o", world, "--json"]
    command += ["--memory", str(bound)] if bound else []
    say("$ " + " ".join(command))
    with tempfile.TemporaryFile("w+") as out:
        process = os.posix_spawn(command[0], command, os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, out.fileno(), 1)])
        _, status, used = os.wait4(process, 0)
        if os.waitstatus_to_exitcode(status) != 0:
            sys.exit("it failed")
        out.seek(0)
        return json.loads(out.read()), used.ru_maxrss * 1024


def fingerprint(folder):
    """One number of all files and their names."""
    every = hashlib.sha256()
    for path in sorted(pathlib.Path(folder).rglob("*")):
        if path.is_file():
            every.update(str(path.relative_to(folder)).encode())
            with open(path, "rb") as file:
                every.update(hashlib.file_digest(file, "sha256").digest())
    return every.hexdigest()


def rows(areas, cell):
    for area in areas:
        known = None
        for bound in (1000,) if area > LARGE else (0, 1000, 200):
            with tempfile.TemporaryDirectory(dir=ROOT / "build") as folder:
                report, peak = bake(area, bound, cell, f"{folder}/w.throng")
                print_of = fingerprint(f"{folder}/w.throng")
            known = known or print_of
            seconds = report["seconds_total"] + report["seconds_nodes"]
            size = report["bytes"] + report["graph_bytes"] + report["air_bytes"] + report["node_bytes"]
            bytes_a_zone = size / report["zones"] / 1e6
            same = "-" if not bound or area > LARGE else "yes" if print_of == known else "NO"
            kept = "-" if not bound else "met" if peak <= (bound << 20) + SLACK else "MISSED"
            yield (f"{area:g} km2, {report['triangles'] / 1e6:.1f} M triangles", f"{bound} MiB" if bound else "none", report["zones"],
                   f"{seconds:.0f}", f"{seconds / report['zones']:.2f}", f"{bytes_a_zone:.2f}", f"{peak / 1e6:.0f} MB", same, kept)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--areas", nargs="+", type=float, default=[1, 4, 16, 100], metavar="KM2")
    parser.add_argument("--cell", type=float, default=0.25)
    options = parser.parse_args()
    found = list(rows(options.areas, options.cell))
    write_between("bounded_bakes_table", f"Machine: {machine()}. `builtin:landscape` with air, nodes and five classes, cells of {options.cell:g} m.\n\n" +
                  table(["world", "`--memory`", "zones", "seconds", "s a zone", "MB a zone", "peak", "same bytes", f"kept to, and {SLACK >> 20} MiB"], found))
    sys.exit(any(row[-1] == "MISSED" or row[-2] == "NO" for row in found))


main()
