# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Sends crowds through corridors, crossings and the cases of SteerBench: do all arrive, and when?

scripts/results scenes [--seeds N]"""
import argparse
import statistics
import sys

from results_page import ROOT, WORLDS, run_json, say, table, write_between

SCENES = ROOT / "build/release/bench/bench_scenes"
RUNS = [("corridor", 2000, 4), ("corridor", 2000, 2), ("crossing", 1000, 4), ("crossing", 1000, 2), ("crossing", 1000, 1)]
MAX_SECONDS = {4: 1000, 2: 600, 1: 600}  # By area for each. [s]


def row(name, runs, area):
    arrived = min(r["arrived"] for r in runs)
    faults = sum(r["overlaps"] + r["wall_entries"] for r in runs)
    seconds = sorted(r["seconds"] for r in runs)
    done = arrived == runs[0]["bodies"]
    time = f"{statistics.median(seconds):.0f} ({seconds[0]:.0f} to {seconds[-1]:.0f})" if done else f"not within {seconds[-1]:.0f}"
    return (name, runs[0]["bodies"], area, f"{runs[0]['alone']:.0f}", time, arrived, f"{sum(r['checked_avatar_steps'] for r in runs):,}",
            faults, "met" if done and faults == 0 else "MISSED")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=3)
    options = parser.parse_args()
    seeds = range(1, options.seeds + 1)
    rows = []
    for scene, bodies, area in RUNS:
        runs = [run_json(SCENES, scene, "--bodies", bodies, "--area", area, "--seconds", MAX_SECONDS[area], "--seed", seed, "--check-every", 5)
                for seed in seeds]
        rows.append(row(scene, runs, area))
    for case in sorted((WORLDS / "steersuite").glob("*.xml")):
        rows.append(row(case.stem, [run_json(SCENES, case, "--seconds", 200, "--seed", seed) for seed in seeds], "-"))
    head = ("scene", "walkers", "m2 for each at first", "s, if alone", "s until all have arrived", "arrived, of the worst seed",
            "avatar-steps checked", "overlaps and walls entered", "all arrive, 0 faults")
    write_between("scenes_table", f"Of {options.seeds} seeds, median (smallest to largest).\n\n" + table(head, rows))
    say("done")


if __name__ == "__main__":
    sys.exit(main())
