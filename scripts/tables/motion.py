# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Runs the tests of motion, several seeds each: one row for what is asked of crowds, real people beside it.

scripts/results motion [--threads T] [--seeds N]"""
import argparse
import re

from results_page import PROGRAM, machine, run_json, table, write_between

TESTS = ("motion", "bottleneck", "fundamental", "lanes", "crossing", "arch")
# What, of which test, the measures whose range is shown, those that must be met, real people.
ROWS = (
    ("0.9 m door, 150 people: path by straight line", "motion.door", r"^path by straight line, run"),
    ("the same: turns of more than 90 degrees", "motion.door", r"^turns of more than 90 degrees, run"),
    ("the same: change of speed in 0.4 s, rms", "motion.door", r"^change of speed in 0.4 s, run"),
    ("the same: walked away from the door, a person", "motion.door", r"^walked away from the door, run"),
    ("the same: turning rate of orientations", "motion.door", r"^turning rate of orientations, run"),
    ("people that wait or have arrived, after 30 s: mean speed", "motion.rest", r": mean speed$"),
    ("flow through 0.8 to 5 m at 1 to 5 m/s", "motion.haste", r"^flow by width"),
    ("the same: left behind", "motion.haste", r"^left behind"),
    ("flow through 1 m at 0.5 to 5 m/s", "motion.flow", r"^flow by width"),
    ("flow through a door of 0.5 m", "motion.narrow", r"^flow, 0.5 m$"),
    ("flow through a door of 0.6 m", "motion.narrow", r"^flow, 0.6 m$"),
    ("flow through a door of 0.7 m", "motion.narrow", r"^flow, 0.7 m$"),
    ("flow through doors of 0.5 to 0.8 m, by width", "motion.narrow", r"^flow by width"),
    ("flow through doors of 0.8 to 2.5 m, by width", "bottleneck", r"^flow by width"),
    ("the same: share of the variance that J = k b explains", "bottleneck", r"^share of the variance"),
    ("speed by density: mean error", "fundamental", r"^mean"),
    ("two people in 14 corridors, seeds with both through", "motion.passages", r"^1 against 1.*seeds with all there$"),
    ("20 against 20 in 3 corridors, seeds with all through", "motion.passages", r"^20 against 20.*seeds with all there$"),
    ("four streams around a pillar: arrived", "motion.pillar", r"^arrived"),
    ("four streams on a square: arrived", "motion.square", r"^arrived"),
    ("four streams in a roundabout: arrived", "motion.roundabout", r"^arrived"),
    ("50 against 50, door of 0.8 m: arrived", "motion.counterflow", r"^arrived, door"),
    ("1000 against 1000, corridor of 4 m: arrived", "motion.counterflow", r"^arrived, corridor of 4 m$"),
    ("corridor of 2.4 m, fed from both sides: arrived", "motion.counterflow", r"^arrived, corridor of 2.4 m, fed"),
    ("1000 mazes, 30 people each: with all there", "motion.mazes", r"^mazes with all there"),
    ("1000 people in the garage: speed by the desired one", "motion.jams", r"at the end$"),
    ("lanes in counterflow", "lanes", r""),
    ("crossing streams", "crossing", r""),
    ("crowd before a door: to the side by to the front", "arch", r""),
)


def number(value):
    return "none" if value is None else f"{value:.4g}"


def limits(measure):
    low, high = measure.get("low"), measure.get("high")
    if low is None and high is None:
        return ""
    if low is None or high is None:
        return f">= {low:g}" if high is None else f"<= {high:g}"
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"


def row(runs, what, test, pattern):
    measures = [m for found in runs for m in found[test]["measures"] if re.search(pattern, m["name"])]
    judged = [m for m in measures if "passed" in m]
    if not pattern:
        measures = judged
    values = sorted(m["value"] for m in measures if m["value"] is not None)
    shown = dict.fromkeys(map(number, (values[0], values[-1]) if values else ()))
    unit = measures[0]["unit"] if len({m["unit"] for m in measures}) == 1 else ""
    asked = " / ".join(dict.fromkeys(map(limits, judged)))
    short = [m for m in judged if not m["passed"]]
    verdict = "" if not judged else "met" if not short else f"MISSED {len(short)} of {len(judged)}"
    people = [m for found in runs for m in found[test]["measures"] if m["name"] == measures[0]["name"].split(", run")[0] + ", people recorded"]
    return (what, test, f"{' to '.join(shown)} {unit}".strip(), number(people[0]["value"]) if people else "", asked, verdict)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--threads", default=0, type=int)
    parser.add_argument("--seeds", default=3, type=int)
    options = parser.parse_args()
    runs = []
    for seed in range(1, options.seeds + 1):
        found = run_json(PROGRAM, "validate", *TESTS, "--json", "--threads", options.threads, "--seed", seed)["tests"]
        runs.append({test["test"]: test for test in found})
    faults = sum(t["overlaps"] + t["wall_entries"] + t["obstacle_entries"] for found in runs for t in found.values())
    checks = sum(t["checks"] for found in runs for t in found.values())
    write_between("motion_table", f"Machine: {machine()}. {options.seeds} seeds: numbers from min to max over all runs, widths and speeds.\n\n" +
                  table(["what", "test", "here", "real people", "asked", ""], [row(runs, *r) for r in ROWS]) +
                  f"\n\nOverlaps and walls entered: {faults} in {checks} checks.")


main()
