# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Compares how flyers of a crowd avoid each other: ours, and by [CAACD] along one axis or two.

scripts/results caacd_air [--seeds N]"""
import argparse
import statistics

from results_page import PROGRAM, WORK, run_json, table, write_between

STEPS = 300
METHODS = [("ours", ()), ("[CAACD], side", ("--axes", "side")), ("[CAACD], side and up", ("--axes", "side-and-up"))]


def row(world, avatars, name, words, seeds):
    found = [run_json(PROGRAM, "run", world, "--json", "--class", "flyer", "--avatars", avatars, "--steps", STEPS, "--near", 60, "--seed", seed,
                      "--goals", "random", "--model", "caacd", *words) for seed in range(1, seeds + 1)]

    def mean(of):
        return statistics.mean(of(r) for r in found)
    avatar_steps = avatars * STEPS
    return (avatars, name, f"{mean(lambda r: r['arrived']):.0f}", f"{mean(lambda r: r['progress']):.3f}",
            f"{100 * mean(lambda r: r['blocked']) / avatar_steps:.2f}", f"{100 * mean(lambda r: r['contested']) / avatar_steps:.2f}",
            sum(r["checks"] for r in found) * avatars, sum(r["overlaps"] + r["wall_entries"] for r in found))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=3)
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    world = WORK / "city_air.throng"
    run_json(PROGRAM, "bake", "builtin:city", "-o", world, "--cell", 0.2, "--fly", "--json")
    rows = [row(world, avatars, name, words, options.seeds) for avatars in (1000, 5000) for name, words in METHODS]
    write_between("caacd_air_table", table(("flyers", "avoid", "goals reached", "progress", "stood, %", "contested, %", "avatar-steps checked", "faults"),
                                            rows))


if __name__ == "__main__":
    main()
