# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Walks crowds through a city with crates that move and carts that drive: times and overlaps.

scripts/results obstacles [--avatars N...] [--steps N]"""
import argparse
import shutil

from results_page import PROGRAM, ROOT, WORK, machine, run_json, table, write_between

BENCH = ROOT / "build/release/bench/bench_obstacles"
SIDE = 200  # of the city [m]
CELL = 0.2  # [m]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--avatars", nargs="+", default=[1000, 10000], type=int)
    parser.add_argument("--steps", default=300, type=int)
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    folder = WORK / "city.throng"
    run_json(PROGRAM, "bake", f"builtin:city,size={SIDE}", "-o", folder, "--rebuild", "--cell", CELL, "--json")
    rows, hashes = [], set()
    avatar_steps = faults = 0
    for avatars in options.avatars:
        for threads in (1, 2):
            report = run_json(BENCH, folder, "--avatars", avatars, "--steps", options.steps, "--threads", threads)
            alone, others, costs = report["alone"], report["with"], report["costs"]
            found = sum(run[k] for run in (alone, others) for k in ("wall_entries", "overlaps", "obstacle_entries"))
            faults += found
            avatar_steps += others["avatar_steps"]
            hashes.add((avatars, report["state_hash"]))
            rows.append((avatars, threads, f"{report['crates']} + {report['carts']}",
                         f"{alone['ns']:.0f} ({alone['ns_plan']:.0f})", f"{others['ns']:.0f} ({others['ns_plan']:.0f})",
                         f"{others['planned'] / alone['planned']:.1f}",
                         f"{costs['add_us']:.0f} / {costs['remove_us']:.0f} / {costs['move_us']:.0f}",
                         others["carts_moved"], others["waited"], others["goal_unreachable"], found))
    shutil.rmtree(folder)
    text = (f"Machine: {machine()}. `city` of {SIDE} m, cells of {CELL} m, dt 0.1 s, {options.steps} steps alone and as many "
            "with obstacles.\n\n")
    text += table(["avatars", "threads", "crates + carts", "ns an avatar a step alone (of it paths)", "with them",
                   "times as many paths", "us to add / remove / move one", "carts moved", "waited", "goal unreachable", "faults"], rows)
    same = "the same" if len(hashes) == len(options.avatars) else "DIFFERENT"
    text += (f"\n\n{avatar_steps} avatar steps among obstacles, {faults} faults in those checked; states are {same} for 1 "
             "and 2 threads.\n")
    write_between("obstacles_table", text)


main()
