# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Runs the scenarios of Moving AI's grid maps: lengths and times.

scripts/results movingai [--runs N] [--sample N]"""
import argparse
import sys

from results_page import ROOT, WORLDS, machine, run_json, table, write_between

BENCH = ROOT / "build/release/bench/bench_grid_maps"
MAPS = ("arena", "lak303d", "brc202d", "orz900d", "Berlin_0_512", "AcrosstheCape")


def row(name, labels, options):
    path = WORLDS / f"movingai/{name}.map"
    found = run_json(BENCH, path, f"{path}.scen", "--runs", options.runs, "--sample", 0 if labels else options.sample,
                     *(["--labels"] if labels else []))
    oracle = found["oracle"]
    judged = "as above" if labels else (f"{oracle['mean_ratio']:.6f}, at most {oracle['worst_ratio']:.6f}, of {oracle['judged']}; "
                                        f"{oracle['shorter_than_the_optimum']} shorter: "
                                        f"{'met' if oracle['mean_ratio'] <= 1.01 and not oracle['shorter_than_the_optimum'] else 'MISSED'}")
    return (f"{name}, {'labels' if labels else 'search'}", f"{found['reached']} / {found['queries']}", judged,
            f"{found['length_by_octile']:.4f} ({found['longer_than_octile']} longer)",
            f"{found['mean_ms']:.4f} ({found['median_ms']:.4f}, {found['worst_ms']:.3f})",
            f"{found['make_seconds']:.3f} s, {found['bytes'] / 1e6:.2f} MB")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--sample", type=int, default=20)
    options = parser.parse_args()
    head = ("map, ours by", "reached", "length / optimum, target <= 1.01", "length / published one, eight directions",
            "ms a query, mean (median, worst)", "to make")
    rows = [row(name, labels, options) for name in MAPS for labels in (False, True)]
    text = (f"Machine: {machine()}. Times: median of {options.runs} runs over all queries, one thread.\n\n" + table(head, rows))
    write_between("movingai_table", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
