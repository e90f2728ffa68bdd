# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Times paths over nodes by distance, by the overlay and by a search of all crossings, and compares lengths.

scripts/results node_path_times [--threads N] [--pairs N]"""
import argparse
import json
import shutil

from results_page import PROGRAM, ROOT, WORK, WORLDS, human, machine, run_json, table, write_between

BENCH = ROOT / "build/release/bench/bench_node_paths"
CLASSES = [
    {"name": "adult", "max_drop": 1.5},
    {"name": "climber", "climb_slope": 120},
]


def worlds():
    """Name, model, cell, size of nodes, distances."""
    if (WORLDS / "nel").exists():
        yield "nel", WORLDS / "nel", 0.25, 1, (20, 100, 500, 1000, 2000)
    yield "landscape, 1600 m", "builtin:landscape,size=1600", 0.5, 1, (20, 100, 500, 1000, 2000)
    yield "city, 2000 m", "builtin:city,size=2000", 0.5, 1, (20, 100, 500, 1000, 2000)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--threads", default=2, type=int)
    parser.add_argument("--pairs", default=60, type=int)
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    classes = WORK / "node_path_times.json"
    classes.write_text(json.dumps({"class": CLASSES}))
    rows, crates = [], []
    differ = judged = parted = 0
    for name, model, cell, size, distances in worlds():
        folder = WORK / "node_path_times.throng"
        run_json(PROGRAM, "bake", model, "-o", folder, "--cell", cell, "--node-size", size, "--classes", classes, "--threads",
                 options.threads, "--nodes", "--rebuild", "--json")
        for avatar in CLASSES:
            found = run_json(BENCH, folder, "--class", avatar["name"], "--distances", ",".join(map(str, distances)), "--pairs", options.pairs,
                             "--judged", options.pairs // 2, "--threads", options.threads)
            made = f"{found['seconds']:.1f} s, {human(found['bytes'])} ({found['search_seconds']:.1f} s, {human(found['search_bytes'])})"
            for paths in found["paths"]:
                differ += paths["differ"]
                judged += options.pairs // 2
                rows.append((name, avatar["name"], found["crossings"], made, f"{paths['distance']:.0f}", f"{paths['reached']} of {paths['pairs']}",
                             f"{paths['mean_length']:.0f}", f"{paths['median_ms']:.2f}, {paths['max_ms']:.2f}",
                             f"{paths['search_median_ms']:.2f}, {paths['search_max_ms']:.2f}",
                             f"{paths['expanded']:.0f}, {paths['searched']:.0f}",
                             f"{paths['mean_ratio']:.4f}, {paths['worst_ratio']:.4f} of {paths['judged']}",
                             f"{paths['unreachable_median_ms']:.2f}, {paths['unreachable_max_ms']:.2f}"))
            for put in found["crates"]:
                parted += put["differ"]
                crates.append((name, avatar["name"], f"{put['distance']:.0f}", put["crates"], f"{put['before_median_ms']:.2f}",
                               f"{put['add_median_ms']:.2f}", f"{put['find_median_ms']:.2f}",
                               f"{put['until_median_ms']:.2f}, {put['until_max_ms']:.2f}", f"{put['without_median_ms']:.2f}",
                               f"{put['mean_ratio']:.4f}, {put['worst_ratio']:.4f}", put["shut"]))
        shutil.rmtree(folder)
    text = (f"Machine: {machine()}. Random places about this far from each other, one run, one thread; half of the pairs searched for "
            f"over all crossings too: {differ} of {judged} of which only one of the two searches reaches the goal.\n\n")
    text += table(["world", "class", "crossings", "to make (without overlay)", "m apart", "reached", "mean length [m]", "ms, median and max",
                   "searched over all: ms", "expanded, median: by overlay, over all", "length / that: mean, max", "unreachable: ms, median and max"], rows)
    text += ("\n\nA crate of 1 m placed in the middle of each path at run time. Milliseconds, medians; lengths of the paths around them / "
             f"those that a search of all crossings finds; {parted} of which only one of the two finds a path:\n\n")
    text += table(["world", "class", "m apart", "crates", "the path before", "to add", "the path around", "until it avoids the crate: median, max",
                   "the path after its removal", "length / that: mean, max", "disconnected"], crates)
    write_between("node_path_times_table", text)


main()
