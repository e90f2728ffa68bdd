# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Runs the queries of Moving AI's voxel maps: lengths and times.

scripts/results voxel [--runs N] [--sample N] [--most N]"""
import argparse
import sys

from results_page import ROOT, WORLDS, machine, run_json, table, write_between

BENCH = ROOT / "build/release/bench/bench_voxel_maps"
MAPS = ("Simple", "Complex", "A1", "DA2")


def row(name, options):
    found = run_json(BENCH, WORLDS / f"movingai/{name}.3dmap", "--runs", options.runs, "--sample", options.sample, "--most", options.most)
    oracle = found["oracle"]
    met = {True: "met", False: "MISSED"}
    judged = (f"{oracle['mean_ratio']:.4f}, at most {oracle['worst_ratio']:.4f}, of {oracle['judged']} ({oracle['shorter_than_over_corners']} shorter, "
              f"{oracle['given_up']} too large to decide): {met[oracle['mean_ratio'] <= 1.02 and oracle['judged'] > 0]}")
    return (f"{name}, {found['voxels']} filled", f"{found['reached']} / {found['queries']}, {found['illegal']} illegal", judged,
            f"{found['length_by_published']:.4f} ({found['longer_than_published']} longer)",
            f"{found['median_ms']:.3f}: {met[found['median_ms'] < 1]}", f"{found['mean_ms']:.3f}, {found['p99_ms']:.2f}",
            f"{found['worst_ms']:.1f}: {met[found['worst_ms'] < 100]}", f"{found['mean_nodes']:.0f}",
            f"{found['file_bytes'] / 1e3:.0f} kB / {found['boxes']}, {found['bytes'] / 1e6:.1f} MB / {found['make_seconds']:.2f} s")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--sample", type=int, default=100)
    parser.add_argument("--most", type=int, default=1500, help="corners of a judged query")
    options = parser.parse_args()
    head = ("map", "reached", "length / any-angle optimum over corners, target <= 1.02", "length / published one, 26 directions",
            "ms a query, median, target < 1", "mean, 99 %", "worst, target < 100", "boxes expanded, mean", "octree / boxes / to make")
    rows = [row(name, options) for name in MAPS]
    text = (f"Machine: {machine()}. Times: of each query the shortest of {options.runs} runs, one thread.\n\n" + table(head, rows))
    write_between("voxel_table", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
