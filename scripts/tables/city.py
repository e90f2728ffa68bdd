# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bakes cities of up to 100 square kilometres and times long paths through them.

scripts/results city [--threads N] [--sides 1000,2000,4000,10000]"""
import argparse
import shutil
import sys

from results_page import PROGRAM, ROOT, WORK, human, machine, run_json, table, write_between

BENCH = ROOT / "build/release/bench/bench_long_paths"
MAX_MEMORY = 4 << 30  # [bytes]
MAX_MS = 1  # Median of the longest paths. [ms]


def distances(side):
    return [d for d in (500, 2000, 10000) if d <= side]


def bake_row(report, found):
    area = found["area_km2"]
    verdict = "met" if report["peak_bytes"] < MAX_MEMORY else "MISSED"
    nodes = found["rectangles"]
    return (f"{area:.1f}", report["triangles"], f"{report['seconds_total']:.1f}", f"{report['seconds_total'] / area:.2f}",
            f"{report['seconds_total'] / report['zones_baked'] * 1e3:.1f}", human(report["bytes"]),
            f"{human(report['peak_bytes'])}: {verdict}", f"{nodes / area:.0f}", f"{found['mesh_bytes'] / nodes:.0f}",
            f"{found['open_ms']:.1f}")


def path_rows(found):
    made = f"{found['make_seconds']:.0f} s, {human(found['bytes'])}"
    for paths in found["paths"]:
        if not paths["pairs"]:
            continue
        longest = paths["distance"] >= 10000
        median = f"{paths['median_ms']:.3f}"
        if longest:
            median += f", target < {MAX_MS}: {'met' if paths['median_ms'] < MAX_MS else 'MISSED'}"
        yield (f"{found['area_km2']:.1f}", made, f"{paths['distance']:g}", paths["pairs"], f"{paths['mean_length']:.0f}", median,
               f"{paths['p99_ms']:.3f}", f"{paths['mean_ratio']:.5f}, at most {paths['worst_ratio']:.5f} of {paths['judged']}",
               f"{paths['search_median_ms']:.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--sides", default="1000,2000,4000,10000")
    parser.add_argument("--judged", type=int, default=10)
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    folder = WORK / "long.throng"
    bakes, paths = [], []
    for side in map(int, options.sides.split(",")):
        report = run_json(PROGRAM, "bake", f"builtin:city,size={side}", "-o", folder, "--rebuild", "--cell", 0.5, "--threads",
                          options.threads, "--json")
        lengths = distances(side)
        found = run_json(BENCH, folder, "--distances", ",".join(map(str, lengths)), "--judged", options.judged)
        bakes.append(bake_row(report, found))
        paths += path_rows(found)
    shutil.rmtree(folder)
    text = (f"Machine: {machine()}. Built-in city, cells of 0.5 m, four classes, {options.threads} threads. Nodes: rectangles of the adult's mesh; "
            "bytes a node: the mesh's. Above 16 km2 some houses have no inside, so triangles grow more slowly.\n\n")
    text += table(["km2", "triangles", "bake [s]", "s / km2", "ms a zone", "zone files", "peak memory, target < 4.3 GB", "nodes / km2",
                   "bytes a node", "open [ms]"], bakes)
    text += "\n\nPaths for the adult by zones, one thread; the search is `PathFinder` without zones, which is exact.\n\n"
    text += table(["km2", "to make, bytes", "apart [m]", "pairs", "mean length [m]", "median [ms]", "99 % [ms]",
                   "length / shortest", "search, median [ms]"], paths)
    write_between("city_table", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
