# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bakes every world for six walking classes, and for each alone: do they reach the same, at which time and bytes?

scripts/results classes [--runs R] [--only TEXT] [--threads T]"""
import argparse
import json
import shutil
import statistics

from all_worlds import worlds
from results_page import PROGRAM, WORK, human, machine, run_json, table, write_between

CLASSES = [
    {"name": "adult"},
    {"name": "child", "height": 1.1, "radius": 0.18, "step": 0.3},
    {"name": "wheelchair", "height": 1.35, "radius": 0.4, "step": 0.02, "max_slope": 3.4336303624505224},
    {"name": "giant", "height": 3.0, "radius": 0.5, "step": 0.8},
    {"name": "dog", "height": 0.6, "radius": 0.2, "step": 0.25, "max_slope": 40},
    {"name": "porter", "height": 2.1, "radius": 0.35, "step": 0.3, "max_slope": 20},
]
TARGET = 1.5
MAX_RUNS, SECONDS = 25, 8  # Of a world's bakes, if they are short: as many as take about SECONDS.


def classes_file(name, classes):
    path = WORK / f"{name}.json"
    path.write_text(json.dumps({"class": classes}))
    return path


def bake(model, words, classes, options):
    """The folder, and the report of one bake."""
    folder = WORK / "classes.throng"
    run = run_json(PROGRAM, "bake", model, *words, "-o", folder, "--rebuild", "--cell", 0.1, "--classes", classes, "--threads", options.threads, "--json")
    run["graph_bytes"] += (folder / "graph.thm").stat().st_size  # the index
    return folder, run


def medians(runs):
    return {key: statistics.median(run[key] for run in runs) for key in ("seconds_graph", "graph_bytes", "seconds_total", "bytes")}


def reached(folder):
    """By class: the areas of its components, the largest first [m2]. And the numbers of regions and links."""
    found = run_json(PROGRAM, "components", folder, "--limit", 10**9, "--json")
    areas = {entry["class"]: sorted((round(part["area"], 6) for part in entry["largest"]), reverse=True) for entry in found["classes"]}
    return areas, (found["regions"], found["links"])


def difference(a, b):
    """Between the areas of components, one by one; those that only one has count whole. [m2]"""
    rest = max(len(a), len(b))
    return sum(abs(p - q) for p, q in zip(a + [0] * (rest - len(a)), b + [0] * (rest - len(b))))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", default=3, type=int)
    parser.add_argument("--only", default="", help="worlds whose name has this text; prints, writes nothing")
    parser.add_argument("--threads", default=2, type=int)
    options = parser.parse_args()
    rows, unlike, met, light, max_share = [], 0, 0, 0, 0
    for name, model, words in worlds():
        if options.only not in name:
            continue
        sets = [CLASSES, *([avatar] for avatar in CLASSES)]
        files = [classes_file("six" if len(of) > 1 else of[0]["name"], of) for of in sets]
        runs = [[] for _ in sets]
        areas_alone, max_of_one = {}, (1, 1)
        for of, file, mine in zip(sets, files, runs):
            folder, run = bake(model, words, file, options)
            mine.append(run)
            reach, of_one = reached(folder)
            if len(of) > 1:
                together, counts = reach, of_one
            else:
                areas_alone |= reach
                max_of_one = tuple(map(max, max_of_one, of_one))
        differing, largest, share = 0, 0, 0
        for avatar in CLASSES:
            mine, shared = areas_alone[avatar["name"]], together[avatar["name"]]
            off = difference(mine, shared)
            differing += off > 0
            largest = max(largest, off)
            share = max(share, off / max(1, sum(mine)))
        # Alternating; times of milliseconds need many runs.
        first = sum(mine[0]["seconds_total"] for mine in runs)
        count = max(options.runs, min(MAX_RUNS, int(SECONDS / first)))
        for _ in range(count - 1):
            for file, mine in zip(files, runs):
                mine.append(bake(model, words, file, options)[1])
        all_six, *alone = map(medians, runs)
        shutil.rmtree(folder)
        ratio = {key: all_six[key] / max(1e-9, max(one[key] for one in alone)) for key in all_six}
        good = ratio["seconds_graph"] <= TARGET and ratio["graph_bytes"] <= TARGET
        unlike += differing
        met += good
        light += ratio["graph_bytes"] <= TARGET
        max_share = max(max_share, share)
        rows.append((name, f"{sum(len(parts) for parts in together.values()):,}", differing, f"{largest:.2f}",
                     f"{share * 100:.4f}", f"{all_six['seconds_graph'] * 1e3:.1f}",
                     human(int(all_six["graph_bytes"])), f"{ratio['seconds_graph']:.2f}", f"{ratio['graph_bytes']:.2f}",
                     " / ".join(f"{six / one:.2f}" for six, one in zip(counts, max_of_one)),
                     f"{ratio['seconds_total']:.2f}", f"{ratio['bytes']:.2f}", "met" if good else "MISSED"))
    text = (f"Machine: {machine()}. Cells of 0.1 m, {options.threads} threads, medians of {options.runs} bakes, of up to {MAX_RUNS} where they are short, alternating. {len(rows)} worlds, {len(CLASSES)} classes: "
            f"{unlike} of {len(rows) * len(CLASSES)} reach something else than alone (target 0), by {max_share * 100:.3f} % of their ground at most; {met} worlds with at most {TARGET} times the time and bytes of one class, {light} with at most {TARGET} times its bytes.\n\n")
    text += table(["world", "components, all classes", "classes that reach something else than alone", "by at most [m2]", "and [%]", "graph of six [ms]", "its bytes",
                   "time of 6 / 1", "bytes of 6 / 1", "regions / links of 6 / 1", "whole bake: time of 6 / 1", "zone files: bytes of 6 / 1", f"graph <= {TARGET}"], rows)
    if options.only:
        print(text)
    else:
        write_between("classes_table", text)


main()
