# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bakes worlds for two flying classes and verifies their paths against the triangles.

scripts/results flight [--pairs N]"""
import argparse
import sys

from results_page import PROGRAM, WORK, WORLDS, human, machine, run_json, say, table, write_between

CLASSES = """[[class]]
name = "flyer"
radius = 0.4
flies = true

[[class]]
name = "drone"
height = 0.3
radius = 0.25
step = 0.1
max_slope = 20
flies = true
"""
# World, cell [m], share of the pairs: paths over all of nel take a second each.
RUNS = [("builtin:garage", 0.1, 10), ("builtin:church", 0.1, 10), ("builtin:bridge", 0.1, 10), ("builtin:landscape", 0.2, 10),
        ("recast/nav_test.obj", 0.1, 10), ("recast/dungeon.obj", 0.1, 10), ("sponza/sponza.obj", 0.1, 20), ("recast/city400.obj", 0.2, 10),
        ("nel", 0.5, 1)]


def rows_of(source, cell, share, classes, options):
    path = source if source.startswith("builtin:") else WORLDS / source
    name = source.split("/")[-1].replace("builtin:", "").replace(".obj", "")
    world = WORK / f"flight_{name}.throng"
    bake = run_json(PROGRAM, "bake", path, "-o", world, "--classes", classes, "--cell", cell, "--rebuild", "--json")
    air = run_json(PROGRAM, "info", world, "--json")["air"]
    pairs = -(-options.pairs * share // (2 * sum(run[2] for run in RUNS)))  # rounded up
    total = {"pairs": 0, "entered": 0}
    rows = []
    for avatar in ("flyer", "drone"):
        found = run_json(PROGRAM, "verify", world, "--source", path, "--class", avatar, "--samples", pairs * 10, "--json")
        flight = found["classes"][0]["flight"]
        total["pairs"] += flight["pairs"]
        total["entered"] += flight["entered"]
        rows.append((f"{name}, {avatar}", f"{cell} / {air['cell']:g}", f"{air['free_cells'] / 1e6:.1f}", f"{human(bake['air_bytes'])} ({human(bake['bytes'])})",
                     f"{bake['seconds_air']:.2f} ({bake['seconds_total']:.2f})", flight["points"], f"{flight['reached']} / {flight['pairs']}",
                     flight["segments"], flight["positions"], flight["entered"]))
    return rows, total


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=10000)
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    classes = WORK / "flight_classes.toml"
    classes.write_text(CLASSES)
    rows, pairs, entered = [], 0, 0
    for run in RUNS:
        found, total = rows_of(*run, classes, options)
        rows += found
        pairs += total["pairs"]
        entered += total["entered"]
    head = ("world, class", "cell / voxel [m]", "free voxels, million", "air files (ground's)", "s to bake the air (all)", "points", "reached / pairs",
            "segments in the air", "bodies on them", "entered")
    verdict = "met" if entered == 0 and pairs >= options.pairs else "MISSED"
    write_between("flight_table", f"Machine: {machine()}. {pairs} pairs, {entered} illegal, target 0 of 10000: {verdict}.\n\n" + table(head, rows))
    say("done")
    return 0 if entered == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
