#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Peak memory of paths and crowds in a world of 9 km2, with and without a bound.

scripts/results bounded [--world FOLDER]: the built-in city of 3 km by 3 km in cells of 0.3 m, baked unless FOLDER has it."""
import argparse
import json
import os
import subprocess
import sys
import tempfile

from results_page import ROOT, machine, say, table, write_between

THRONG = ROOT / "build/release/throng"
START = (1500, 1500)
PATHS = ((200, 64), (1000, 64), (1000, 128), (2000, 128), (2000, 256))  # to the south-east [m], and the bound [MiB]
CROWD_BOUND = 64  # [MiB]


def run(*arguments):
    """What a command prints as JSON, and its peak of memory [bytes]; exits if it fails."""
    command = [str(THRONG), *map(str, arguments), "--json"]
    say("$ " + " ".join(command))
    with tempfile.TemporaryFile("w+") as out:
        process = os.posix_spawn(command[0], command, os.environ, file_actions=[(os.POSIX_SPAWN_DUP2, out.fileno(), 1)])
        _, status, used = os.wait4(process, 0)
        if os.waitstatus_to_exitcode(status) not in (0, 1):
            sys.exit("it failed")
        out.seek(0)
        return json.loads(out.read()), used.ru_maxrss * 1024


def megabytes(size):
    return f"{size / 1e6:.0f} MB"


def path_row(world, length, bound):
    side = length / 2**0.5
    query = ("path", world, "--from", f"{START[0]},1,{START[1]}", "--to", f"{START[0] + side:.0f},1,{START[1] + side:.0f}", "--tolerance", 20)
    whole, peak = run(*query)
    bounded, least = run(*query, "--memory", bound)
    same = "none: it needs more" if bounded["end"] == "budget exhausted" else "yes" if abs(whole["length"] - bounded["length"]) < 1e-6 * whole["length"] else "NO"
    return (f"path, {whole['length']:.0f} m", megabytes(peak), f"{bound} MiB", megabytes(least), same, "met" if least <= bound << 20 else "MISSED")


def crowd_row(world):
    crowd = ("run", world, "--avatars", 1000, "--steps", 300)
    _, peak = run(*crowd, "--near", 100)
    x, z = START
    report, least = run(*crowd, "--part", f"{x},{z},{x + 200},{z + 200}", "--memory", CROWD_BOUND)
    faults = report["overlaps"] + report["wall_entries"]
    return ("1000 avatars in a district of 200 m", megabytes(peak), f"{CROWD_BOUND} MiB", megabytes(least), f"{faults} faults",
            "met" if least <= CROWD_BOUND << 20 else "MISSED")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--world")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        world = options.world or f"{folder}/city.throng"
        if not options.world:
            subprocess.run([THRONG, "bake", "builtin:city,size=3000", "--cell", "0.3", "-o", world], check=True, stdout=subprocess.DEVNULL)
        rows = [*(path_row(world, *asked) for asked in PATHS), crowd_row(world)]
    write_between("bounded_table", f"Machine: {machine()}. Peaks of whole processes. The crowd without a bound is in all of the world.\n\n" +
                  table(["what", "without a bound", "`--memory`", "with it", "same path", "kept to"], rows))


main()
