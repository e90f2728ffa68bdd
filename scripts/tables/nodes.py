# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Makes the nodes of curved and other worlds for six classes and for each alone, and tests them: counts, bytes and times.

Two of the classes climb.

scripts/results nodes [--threads T] [--samples N] [--runs R] [--but WORLD ...] [--everywhere]"""
import argparse
import json
import shutil

import all_worlds
from results_page import PROGRAM, SIX_CLASSES, WORK, WORLDS, human, machine, rows_between, run_json, table, write_between


def worlds():
    """Name, model, square metres, cell, size of nodes."""
    if (WORLDS / "nel").exists():
        yield "nel", WORLDS / "nel", 96 * 160 * 160, 0.25, 1
        yield "nel", WORLDS / "nel", 96 * 160 * 160, 0.25, 2
    yield "landscape, 320 m", "builtin:landscape,size=320", 320 * 320, 0.25, 1
    if (WORLDS / "bezier").exists():
        yield "bezier/teapot.bpt", WORLDS / "bezier/teapot.bpt", None, 0.05, 0.25
    if (WORLDS / "quake3").exists():
        yield "quake3/am_thornish.bsp", WORLDS / "quake3/am_thornish.bsp", None, 0.1, 0.5
    if (WORLDS / "recast").exists():
        yield "recast/nav_test.obj", WORLDS / "recast/nav_test.obj", None, 0.1, 1
        yield "recast/dungeon.obj", WORLDS / "recast/dungeon.obj", None, 0.1, 1
        yield "recast/city400.obj", WORLDS / "recast/city400.obj", 400 * 400, 0.1, 1
    for name in ("garage", "bridge", "church", "powerplant"):
        yield name, f"builtin:{name}", None, 0.1, 1


def classes_file(name, classes):
    path = WORK / f"{name}.json"
    path.write_text(json.dumps({"class": classes}))
    return path


def bake(model, cell, size, classes, threads):
    folder = WORK / "nodes.throng"
    return folder, run_json(PROGRAM, "bake", model, "-o", folder, "--cell", cell, "--node-size", size, "--classes", classes,
                            "--threads", threads, "--nodes", "--rebuild", "--json")


def everywhere(options):
    """One row a world: every built-in world and every model in ../shared/worlds, for the default classes."""
    rows = []
    for name, model, words in all_worlds.worlds():
        folder = WORK / "nodes.throng"
        run = run_json(PROGRAM, "bake", model, *words, "-o", folder, "--cell", 0.1, "--nodes", "--threads", options.threads, "--rebuild", "--json")
        found = run_json(PROGRAM, "surface", folder, "--json")
        info = run_json(PROGRAM, "info", folder, "--json")
        shutil.rmtree(folder)
        low, high = info["bounds_min"], info["bounds_max"]
        area = (high[0] - low[0]) * (high[2] - low[2])
        nodes = found["nodes"]
        rows.append((name, f"{area / 1e6:.4f}", found["zones"], found["patches"], nodes, found["arcs"],
                     f"{found['bytes_a_node']:.1f}" if nodes else "", human(found["bytes"]), f"{nodes / area * 1e6:,.0f}",
                     f"{run['seconds_total'] / max(1, run['zones']):.4f}", f"{run['seconds_nodes'] / max(1, found['zones']):.4f}"))
    text = f"Machine: {machine()}. Cells of 0.1 m, nodes of 1 m, the default classes, {options.threads} threads; one run.\n\n"
    text += table(["world", "km2 in plan", "zones with nodes", "patches", "nodes", "arcs", "bytes a node", "bytes", "nodes a km2", "ground, s a zone",
                   "nodes, s a zone"], rows)
    write_between("nodes_everywhere", text)


def median(values):
    return sorted(values)[len(values) // 2]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--threads", default=2, type=int)
    parser.add_argument("--samples", default=20000, type=int)
    parser.add_argument("--runs", default=3, type=int)
    parser.add_argument("--but", nargs="*", default=[], help="worlds whose rows stay as they are")
    parser.add_argument("--everywhere", action="store_true", help="only the second table, of all worlds")
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    if options.everywhere:
        everywhere(options)
        return
    together = classes_file("together", SIX_CLASSES)
    alone = [classes_file(c["name"], [c]) for c in SIX_CLASSES]
    rows = []
    for name, model, area, cell, size in worlds():
        if name in options.but:
            rows += [row for row in rows_between("nodes_table") if row[:3] == (name, str(cell), str(size))]
            continue
        one = [[bake(model, cell, size, path, options.threads)[1] for _ in range(options.runs)] for path in alone]
        max_seconds = max(median([run["seconds_nodes"] for run in runs]) for runs in one)
        max_bytes = max(runs[0]["node_bytes"] for runs in one)
        runs = [bake(model, cell, size, together, options.threads) for _ in range(options.runs)]
        folder = runs[0][0]
        seconds = median([run["seconds_nodes"] for _, run in runs])
        found = run_json(PROGRAM, "surface", folder, "--json")
        proof = run_json(PROGRAM, "verify", folder, "--source", model, "--nodes", "--samples", options.samples, "--json")
        shutil.rmtree(folder)
        faults = sum(c[key] for c in proof["classes"] for key in ("entered", "unsupported", "steeper", "lower", "one_way"))
        rows.append((name, cell, size, found["patches"], found["nodes"], found["arcs"], f"{found['bytes_a_node']:.1f}",
                     f"{found['nodes'] / area * 1e6:.0f}" if area else "", human(found["bytes"]),
                     f"{seconds:.2f}", f"{seconds * 1000 / found['zones']:.0f}",
                     f"{seconds / max_seconds:.2f}", f"{found['bytes'] / max_bytes:.2f}",
                     f"{sum(c['links_over_holes'] for c in proof['classes'])}", faults))
    text = (f"Machine: {machine()}. Six classes, two of which climb; {options.threads} threads; {options.samples} places a "
            f"class; median of {options.runs} runs. The last ratios: six classes together / the most expensive class alone.\n\n")
    text += table(["world", "cell [m]", "node size [m]", "patches", "nodes", "arcs", "bytes a node", "nodes a km2", "bytes",
                   "nodes [s]", "ms a zone", "time of 6 / 1", "bytes of 6 / 1", "links over holes tested", "faults"], rows)
    write_between("nodes_table", text)
    everywhere(options)


main()
