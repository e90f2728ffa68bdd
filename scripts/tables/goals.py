# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Times the step of a crowd with goals, measures how well crowds flow, and compares with DetourCrowd.

scripts/results goals [--runs N] [--seeds N] [--only speed|flow|city]"""
import argparse
import statistics
import sys

from results_page import ROOT, WORLDS, machine, run_json, say, table, write_between

CROWD = ROOT / "build/release/bench/bench_crowd"
DETOUR = ROOT / "build/release/bench/bench_detour_crowd"
QUALITY = ROOT / "build/release/bench/bench_quality"


def spread(values, digits=0):
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def speed_rows(runs):
    for avatars, rvo in ((10_000, "1250 to 1600"), (100_000, "1400 to 3600"), (1_000_000, "1630 to 5600")):
        found = {}
        for threads in (1, 2):
            found[threads] = [run_json(CROWD, "--avatars", avatars, "--threads", threads) for _ in range(runs)]
        one, two = found[1], found[2]
        last = two[-1]
        yield (avatars, spread([r["ns"] for r in one]), spread([r["ns"] for r in two]),
               " / ".join(f"{statistics.median([r['ns_' + p] for r in two]):.0f}" for p in ("plan", "sort", "steer", "commit", "settle")),
               rvo, f"{100 * last['contested']:.0f} %", f"{last['progress']:.3f}", sum(r["overlaps"] + r["wall_entries"] for r in one + two),
               "yes" if len({r["state_hash"] for r in one + two}) == 1 else "NO", f"{last['bytes_an_avatar']:.0f}")


def quality_rows(seeds):
    for scene, target, options in (("sparse", 0.93, []), ("dense", 0.5, [])):
        runs = [run_json(QUALITY, "--scene", scene, "--seed", seed, *options) for seed in range(1, seeds + 1)]
        values = [r["progress"] for r in runs]
        overlaps = sum(r["overlaps"] for r in runs)
        met = statistics.median(values) >= target and overlaps == 0
        yield (scene, f"progress {spread(values, 3)}", overlaps, f">= {target}, 0 overlaps: {'met' if met else 'MISSED'}")
    runs = [run_json(QUALITY, "--scene", "circle", "--bodies", 1000, "--seconds", 150, "--seed", seed) for seed in range(1, seeds + 1)]
    arrived = [r["arrived"] for r in runs]
    overlaps = sum(r["overlaps"] for r in runs)
    met = min(arrived) == 1000 and overlaps == 0
    yield ("circle of 1000", f"arrived by 150 s: {spread(arrived)}", overlaps, f"1000, 0 overlaps: {'met' if met else 'MISSED'}")


def city_rows():
    for avatars, seconds in ((10_000, 60), (100_000, 20)):
        found = run_json(DETOUR, WORLDS / "recast/city400.obj", "--avatars", avatars, "--seconds", seconds)
        ours = found["throng"]
        target = {"0 overlaps": ours["overlaps"] + ours["wall_entries"] == 0, "all have a path": ours["with_path_after_1_s"] == avatars,
                 "speed >= 0.8": ours["speed_at_end"] >= 0.8}
        if "ratio" in found:
            target["25 x faster"] = found["ratio"] >= 25
        for name in ("throng", "detour"):
            if name not in found:
                continue
            crowd = found[name]
            yield (avatars, seconds, "throng" if name == "throng" else "DetourCrowd", f"{crowd['us_an_update']:.2f} ({crowd['us_median']:.2f})", crowd["with_path_after_1_s"],
                   f"{crowd['speed_at_end']:.2f}", crowd["overlaps"], crowd["deep_overlaps"], crowd.get("wall_entries", "-"),
                   f"{found['ratio']:.1f}" if name == "throng" and "ratio" in found else "-",
                   "; ".join(f"{what}: {'met' if met else 'MISSED'}" for what, met in target.items()) if name == "throng" else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--only", choices=("speed", "flow", "city"))
    options = parser.parse_args()
    if options.only in (None, "speed"):
        head = ("avatars", "ns a step, 1 thread", "ns a step, 2 threads", "plan / sort / steer / commit / settle", "RVO2, 1 thread", "in reach of another",
                "progress", "faults", "same state", "bytes an avatar")
        write_between("goals_table", f"Machine: {machine()}. Median of {options.runs} runs (smallest to largest).\n\n" + table(head, list(speed_rows(options.runs))) +
                      "\nTarget: at most 150 ns an avatar a step for 1 000 000 on 2 threads.\n")
    if options.only in (None, "flow"):
        write_between("flow_table", f"Of {options.seeds} seeds, median (smallest to largest).\n\n" +
                      table(("scene", "result", "overlaps", "target"), list(quality_rows(options.seeds))))
    if options.only in (None, "city"):
        head = ("avatars", "simulated s", "crowd", "us an update, mean (median second)", "with a path after 1 s", "speed at the end / desired", "overlaps, checked each second",
                "deeper than 5 %", "walls entered", "ratio of times", "target")
        write_between("detour_crowd_table", f"Machine: {machine()}. One run, one thread each, alternating.\n\n" + table(head, list(city_rows())))
    say("done")


if __name__ == "__main__":
    sys.exit(main())
