# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Walks the eight crowds of [ML06] Table 1 and compares times.

scripts/results crowd [--steps N] [--largest N]"""
import argparse
import math

from results_page import PROGRAM, ROOT, WORK, human, machine, run_json, table, write_between

# [ML06] Table 1: avatars, milliseconds to draw, milliseconds to move.
PAPER = [(500, 2, 2), (1000, 5, 4), (1500, 7, 6), (2000, 9, 8), (5000, 23, 20), (10000, 48, 39),
         (100000, 467, 395), (1000000, 4780, 3990)]
AREA = 4  # Square metres of walkable garage floor for each avatar, about: the garage comes in whole modules.
SHARE = 2.75  # Walkable floor of a garage of four storeys and a roof, by the square of its size.
SLICE_CELL = 0.4  # [m] About a body wide, as the paper's cells are.
BENCH_DRAW = ROOT / "build/release/bench/bench_draw"
TARGET = 25  # Nanoseconds an avatar a step on two threads.


def size_for(avatars):
    return max(60, math.ceil(math.sqrt(avatars * AREA / SHARE)))


def on_slices(avatars, steps):
    """Milliseconds a step of algorithm 1 on the slices of the same garage, one thread."""
    size = size_for(avatars)
    file = WORK / f"garage_{size}.slices"
    if not file.exists():
        run_json(PROGRAM, "slices", f"builtin:garage,size={size},levels=4", "--cell", SLICE_CELL, "-o", file, "--json")
    run = run_json(PROGRAM, "run", file, "--avatars", avatars, "--steps", steps, "--threads", 1, "--check-every", steps, "--wander", "--json")
    return run["ns_per_avatar_step"] * avatars / 1e6, run["wall_entries"] + run["overlaps"]


def drawing(avatars):
    """Milliseconds that the avatars add to a frame, by a graphics library in software."""
    frame = run_json(BENCH_DRAW, "--avatars", avatars, "--runs", 9)
    return max(0, frame["ms_people"] - frame["ms_empty"])


def garage_for(avatars, cell):
    size = size_for(avatars)
    folder = WORK / f"garage_{size}.throng"
    if not folder.exists():
        run_json(PROGRAM, "bake", f"builtin:garage,size={size},levels=4", "-o", folder, "--cell", cell, "--json")
    return folder


def crowd_rows(steps, largest, cell):
    rows, worst = [], 0
    for avatars, draw, move in PAPER:
        if avatars > largest:
            continue
        world = garage_for(avatars, cell)
        runs = {threads: run_json(PROGRAM, "run", world, "--avatars", avatars, "--steps", steps, "--threads",
                                  threads, "--check-every", steps, "--wander", "--json") for threads in (1, 2)}
        one, two = runs[1], runs[2]
        adult = run_json(PROGRAM, "info", world, "--json")["classes"][0]
        if avatars >= 10000:
            worst = max(worst, two["ns_per_avatar_step"])
        slices, slice_faults = on_slices(avatars, steps)
        faults = one["wall_entries"] + one["overlaps"] + two["wall_entries"] + two["overlaps"] + slice_faults
        rows.append((
            avatars, f"{adult['walkable_area'] / avatars:.1f}", draw, f"{drawing(avatars):.1f}", move, f"{slices:.3f}", f"{one['ns_per_avatar_step'] * avatars / 1e6:.3f}",
            f"{two['ns_per_avatar_step'] * avatars / 1e6:.3f}", f"{move * 1e6 / avatars:.0f}",
            f"{one['ns_per_avatar_step']:.1f}", f"{two['ns_per_avatar_step']:.1f}",
            "yes" if one["state_hash"] == two["state_hash"] else "NO", faults, human(two["crowd_bytes"])))
    return rows, worst


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", default=100, type=int)
    parser.add_argument("--largest", default=1000000, type=int)
    parser.add_argument("--cell", default=0.1, type=float)
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    rows, worst = crowd_rows(options.steps, options.largest, options.cell)
    met = "met" if worst <= TARGET else "MISSED"
    text = (f"Machine: {machine()}. Built-in garage of four storeys with about {AREA} m2 of walkable floor for each avatar (at least 60 m "
            f"wide), cell {options.cell} m, dt 0.1 s; median over {options.steps} steps of the whole step, occupancy included. The "
            f"paper's machine is of 2006; it draws each avatar as a box. *Drawn*: what people add to a frame of 1280 x 720 of a city seen "
            f"from above, 0 where that is less than its noise, on a graphics library in software; *on slices*: by algorithm 1, cells of "
            f"{SLICE_CELL} m.\n\n")
    text += table(["avatars", "m2 for each", "[ML06] draw, ms", "ours, drawn, ms", "[ML06] move, ms", "on slices, 1 thread, ms", "level tiles, 1 thread, ms", "level tiles, 2 threads, ms",
                   "[ML06] ns an avatar", "ours, 1 thread", "ours, 2 threads", "same state", "faults", "memory"], rows)
    if options.largest >= 10000:
        text += (f"\n\nTarget: at most {TARGET} ns an avatar a step on 2 threads, for every crowd from 10 000 to 1 000 000. "
                 f"Slowest of these: {worst:.1f} ns, {met}.")
    write_between("crowd_table", text)


main()
