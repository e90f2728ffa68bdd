# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bakes a city and its nodes by threads and by ranks of mpirun, alternating.

scripts/results ranks [--size METRES] [--runs N] [--print]"""
import argparse
import os
import shutil
import statistics
import time

from results_page import PROGRAM, WORK, human, machine, run_json, table, write_between

MPIRUN = ["mpirun", "--oversubscribe", "--bind-to", "none", *(["--allow-run-as-root"] if os.geteuid() == 0 else [])]
# Name, ranks (0: without mpirun), threads of each rank.
CASES = [("1 thread", 0, 1), ("2 threads", 0, 2), ("1 rank, 1 thread", 1, 1), ("2 ranks, 1 thread each", 2, 1)]


def measure(size, ranks, threads):
    folder = WORK / "ranks.throng"
    start = time.monotonic()
    report = run_json(*([*MPIRUN, "-n", ranks] if ranks else []), PROGRAM, "bake", f"builtin:city,size={size}", "-o", folder,
                      "--rebuild", "--nodes", "--threads", threads, "--json")
    wall = time.monotonic() - start
    shutil.rmtree(folder)
    return report["seconds_total"], report["seconds_nodes"], wall, report["peak_bytes"]


def spread(values):
    return f"{statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", default=1500, type=int)
    parser.add_argument("--runs", default=5, type=int)
    parser.add_argument("--print", action="store_true", help="print the table, write nothing")
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    found = {name: [] for name, _, _ in CASES}
    for _ in range(options.runs):
        for name, ranks, threads in CASES:
            found[name].append(measure(options.size, ranks, threads))
    rows = []
    for name, ranks, _ in CASES:
        bakes, nodes, walls, peaks = zip(*found[name])
        ratios = [found["1 thread"][i][0] / bake for i, bake in enumerate(bakes)]
        node_ratios = [found["1 thread"][i][1] / seconds for i, seconds in enumerate(nodes)]
        rows.append((name, spread(bakes), spread(ratios), spread(nodes), spread(node_ratios), spread(walls),
                     human(max(peaks)) + (" a rank" if ranks else "")))
    text = (f"Machine: {machine()}; load {os.getloadavg()[1]:.1f} over the last five minutes. Built-in city, {options.size} m wide, cells of 0.1 m, four "
            f"classes. {options.runs} alternating runs; median (smallest to largest).\n\n")
    text += table(["by", "bake [s]", "times 1 thread", "nodes [s]", "times 1 thread", "wall clock of the process [s]", "memory"], rows)
    if options.print:
        print(text)
    else:
        write_between("ranks_table", text)


main()
