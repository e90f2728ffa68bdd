# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Checks paths over nodes between random pairs, for six classes, two of which climb, with bodies against all triangles.

scripts/results node_paths [--threads T] [--share S] [--only WORLD ...]"""
import argparse
import json
import shutil

from results_page import PROGRAM, SIX_CLASSES, WORK, WORLDS, human, machine, run_json, table, write_between


def worlds():
    """Name, model, cell, size of nodes, pairs a class."""
    if (WORLDS / "bezier").exists():
        yield "bezier/teapot.bpt", WORLDS / "bezier/teapot.bpt", 0.05, 0.25, 1000
    yield "landscape, 160 m", "builtin:landscape,size=160", 0.5, 1, 1000
    if (WORLDS / "nel").exists():
        yield "nel", WORLDS / "nel", 0.5, 2, 150
    if (WORLDS / "quake3").exists():
        yield "quake3/am_thornish.bsp", WORLDS / "quake3/am_thornish.bsp", 0.1, 0.5, 300
    yield "garage", "builtin:garage", 0.1, 1, 300


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--threads", default=2, type=int)
    parser.add_argument("--share", default=1, type=float, help="share of the pairs")
    parser.add_argument("--only", nargs="*", default=[], help="worlds, by their first letters")
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    classes = WORK / "node_paths.json"
    classes.write_text(json.dumps({"class": SIX_CLASSES}))
    rows = []
    pairs = illegal = 0
    for name, model, cell, size, samples in worlds():
        if options.only and not name.startswith(tuple(options.only)):
            continue
        folder = WORK / "node_paths.throng"
        run_json(PROGRAM, "bake", model, "-o", folder, "--cell", cell, "--node-size", size, "--classes", classes,
                 "--threads", options.threads, "--nodes", "--json")
        proof = run_json(PROGRAM, "verify", folder, "--source", model, "--nodes", "--paths", "--samples", int(samples * options.share),
                         "--threads", options.threads, "--json")
        shutil.rmtree(folder)
        for c in proof["classes"]:
            if c["pairs"] == 0:
                continue
            faults = sum(c[key] for key in ("entered", "unsupported", "broken", "disagree"))
            pairs += c["pairs"]
            illegal += faults
            links = ", ".join(f"{count} {kind}" for kind, count in c["links"].items())
            rows.append((name, c["class"], c["pairs"], c["reached"], c["disconnected"], c["segments"], c["poses"], links, c["links_over_holes"],
                         f"{c['length'] / max(c['straight'], 1e-9):.3f}", f"{c['length'] / max(c['reached'], 1):.0f}",
                         f"{c['search_seconds'] / c['pairs'] * 1000:.2f}", human(c["finder_bytes"]), faults))
    text = (f"Machine: {machine()}. {pairs} pairs, {illegal} faults (target 0). A fault: a segment whose body meets a triangle or has "
            "nothing under its feet, a segment that leaves its node, a connected pair without a path, or the reverse.\n\n")
    text += table(["world", "class", "pairs", "reached", "in different components", "segments", "bodies on them", "links", "links over holes",
                   "length / straight line", "mean length [m]", "ms a query", "path finder", "faults"], rows)
    write_between("node_paths_table", text)


main()
