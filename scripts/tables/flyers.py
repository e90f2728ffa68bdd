# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Times the step of flyers and checks that all arrive.

scripts/results flyers [--runs N]"""
import argparse
import statistics

from results_page import PROGRAM, ROOT, WORK, machine, run_json, table, write_between

FLYERS = ROOT / "build/release/bench/bench_flyers"


def spread(values):
    return f"{statistics.median(values):.0f} ({min(values):.0f} to {max(values):.0f})"


def air_rows(runs):
    for avatars, volume in ((10_000, 64), (10_000, 512), (100_000, 64)):
        found = {n: [run_json(FLYERS, "--avatars", avatars, "--volume", volume, "--threads", n) for _ in range(runs)] for n in (1, 2)}
        last, every = found[2][-1], found[1] + found[2]
        yield (avatars, volume, spread([r["ns"] for r in found[1]]), spread([r["ns"] for r in found[2]]),
               " / ".join(f"{statistics.median([r['ns_' + p] for r in found[2]]):.0f}" for p in ("plan", "sort", "steer", "commit", "settle")),
               f"{last['progress']:.3f}", sum(r["checked_avatar_steps"] for r in every), sum(r["overlaps"] + r["wall_entries"] for r in every),
               "yes" if len({r["state_hash"] for r in every}) == 1 else "NO")


def city_rows():
    WORK.mkdir(parents=True, exist_ok=True)
    world = WORK / "city_air.throng"
    run_json(PROGRAM, "bake", "builtin:city", "-o", world, "--cell", 0.2, "--fly", "--json")
    for avatars in (1000, 5000):
        found = run_json(PROGRAM, "run", world, "--class", "flyer", "--avatars", avatars, "--steps", 300, "--goals", "random", "--near", 60, "--json")
        yield (avatars, f"{found['ns_per_avatar_step']:.0f} ({found['ns_per_avatar_step_mean']:.0f})", found["planned"], found["no_path"],
               found["arrived"], f"{found['progress']:.2f}", found["checks"] * avatars, found["overlaps"] + found["wall_entries"])


def sphere_rows():
    for avatars in (500, 1000):
        for seed in (1, 2, 3)[:3 if avatars == 500 else 1]:
            found = run_json(FLYERS, "--scene", "sphere", "--avatars", avatars, "--seed", seed)
            yield (found["avatars"], seed, found["arrived"], f"{found['seconds']:.1f}", found["checked_avatar_steps"],
                   found["overlaps"] + found["wall_entries"])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--note", default="", help="text added after the machine")
    options = parser.parse_args()
    text = [f"Machine: {machine()}. Median of {options.runs} runs (smallest to largest){options.note}.\n",
            table(("flyers", "m3 for each", "ns a step, 1 thread", "ns a step, 2 threads", "plan / sort / steer / commit / settle", "progress",
                   "avatar-steps checked", "faults", "same state"), air_rows(options.runs)),
            "\nOver `builtin:city` (cells 0.2 m, voxels 0.4 m), 300 steps, goals within 60 m, 2 threads:\n",
            table(("flyers", "ns a step, median (mean)", "paths planned", "without a path", "arrived", "progress", "avatar-steps checked", "faults"),
                  city_rows()),
            "\nAcross a sphere; straight it takes 10 s:\n",
            table(("flyers", "seed", "arrived", "s until all have", "avatar-steps checked", "faults"), sphere_rows())]
    write_between("flyers_table", "\n".join(text))


if __name__ == "__main__":
    main()
