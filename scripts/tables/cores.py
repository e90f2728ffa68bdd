# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bakes a city, makes its nodes, its path finder and steps a large crowd by 1 to 16 threads.

Compares the bytes that come out; writes times and ratios into docs/results.md.

scripts/results cores [--side METRES] [--avatars N] [--threads 1,2,4,8,16] [--measure FILE | --read FILE]

--measure writes the measurements into a file, on a machine that has the built programs but no docs; --read makes the
table of such a file."""
import argparse
import hashlib
import json
import os
import pathlib
import shutil

from results_page import PROGRAM, ROOT, WORK, human, machine, run_json, table, write_between

CROWD = ROOT / "build/release/bench/bench_crowd"
FINDER = ROOT / "build/release/bench/bench_node_paths"


def digest(folder):
    whole = hashlib.sha256()
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        whole.update(str(file.relative_to(folder)).encode() + b"\0" + file.read_bytes())
    return whole.hexdigest()


def measure(options):
    WORK.mkdir(parents=True, exist_ok=True)
    folder = WORK / "cores.throng"
    rows = []
    for threads in options.threads:
        bake = run_json(PROGRAM, "bake", f"builtin:city,size={options.side}", "-o", folder, "--rebuild", "--cell", 0.5, "--nodes",
                        "--threads", threads, "--json")
        finder = run_json(FINDER, folder, "--pairs", 1, "--judged", 0, "--distances", 1000, "--threads", threads)
        crowd = run_json(CROWD, "--avatars", options.avatars, "--threads", threads)
        rows.append({"threads": threads, "bake": bake["seconds_total"], "graph": bake["seconds_graph"], "nodes": bake["seconds_nodes"],
                     "finder": finder["seconds"], "step": crowd["ns"], "peak": bake["peak_bytes"], "world": digest(folder),
                     "crowd": crowd["state_hash"], "faults": crowd["overlaps"] + crowd["wall_entries"]})
        shutil.rmtree(folder)
    return {"machine": machine(), "side": options.side, "avatars": options.avatars, "load": os.getloadavg()[1], "rows": rows}


def text_of(found):
    rows, first = [], found["rows"][0]

    def beside(row, key, digits=2):
        return f"{row[key]:.{digits}f} ({first[key] / row[key]:.1f})"

    for row in found["rows"]:
        rows.append((row["threads"], beside(row, "bake"), beside(row, "graph"), beside(row, "nodes"), beside(row, "finder"), beside(row, "step", 1),
                     human(row["peak"]), row["faults"]))
    worlds = {row["world"] for row in found["rows"]}
    crowds = {str(row["crowd"]) for row in found["rows"]}
    same = "the same" if len(worlds) == len(crowds) == 1 else f"{len(worlds)} WORLDS, {len(crowds)} CROWDS"
    return (f"Machine: {found['machine']}; load {found['load']:.1f} over the last five minutes. Built-in city, {found['side']} m wide, cells of 0.5 m, "
            f"four classes, with nodes; the finder of paths over nodes for one class; {found['avatars']} avatars with goals. One run of each; in brackets: "
            f"the speed-up over one thread. All bytes and states for any number of threads: {same} (SHA-256 of the world {sorted(worlds)[0][:16]}, "
            f"state {sorted(crowds)[0]}).\n\n" +
            table(["threads", "bake [s]", "of it the graph [s]", "nodes [s]", "path finder made [s]", "step [ns an avatar]", "memory of the bake", "faults"], rows))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--side", type=int, default=4000)
    parser.add_argument("--avatars", type=int, default=1_000_000)
    parser.add_argument("--threads", type=lambda text: [int(word) for word in text.split(",")], default=[1, 2, 4, 8, 16])
    parser.add_argument("--measure", type=pathlib.Path)
    parser.add_argument("--read", type=pathlib.Path)
    options = parser.parse_args()
    found = json.loads(options.read.read_text()) if options.read else measure(options)
    if options.measure:
        options.measure.write_text(json.dumps(found))
    else:
        write_between("cores_table", text_of(found))


main()
