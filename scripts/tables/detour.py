# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Finds the same paths with Detour and with throng: times, lengths, legality.

scripts/results detour [--runs N] [--pairs N]"""
import argparse
import sys

from results_page import ROOT, WORLDS, machine, run_json, table, write_between

BENCH = ROOT / "build/release/bench/bench_detour"
# World, the ratio of queries a second to reach, labels (a search over city400 takes tens of milliseconds).
RUNS = [("nav_test", 1, False), ("nav_test", 1, True), ("dungeon", 1, False), ("dungeon", 1, True), ("city400", 20, True)]


def thousands(rate):
    return f"{rate['median'] / 1000:.2f} ({rate['min'] / 1000:.2f} to {rate['max'] / 1000:.2f})"


def row(world, target, labels, options):
    found = run_json(BENCH, WORLDS / f"recast/{world}.obj", "--pairs", options.pairs, "--runs", options.runs,
                     *(["--labels"] if labels else []))
    ratio, detour, ours = found["ratio"], found["detour"], found["throng"]
    verdict = "met" if ratio["median"] >= target else "MISSED"
    longer = found["length_ratio"]
    return (f"{world}, {'labels' if labels else 'search'}", found["pairs"], f"{detour['polygons']} / {ours['rectangles']}",
            thousands(found["detour_queries_per_s"]), thousands(found["throng_queries_per_s"]),
            f"{ratio['median']:.3f} ({ratio['min']:.3f} to {ratio['max']:.3f}), target >= {target}: {verdict}",
            f"{detour['reached']} / {ours['reached']}", f"{detour['legal']} / {ours['missed_legal']}",
            f"{longer:.4f}, target <= 1: {'met' if longer <= 1 else 'MISSED'}",
            f"{found['length_ratio_worst_legal']:.5f}, target <= 1.05: "
            f"{'met' if found['length_ratio_worst_legal'] <= 1.05 else 'MISSED'}",
            f"{ours['seconds']:.2f} s, {ours['bytes'] / 1e6:.1f} MB")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--pairs", type=int, default=10000)
    options = parser.parse_args()
    head = ("world, ours by", "pairs", "Detour's polygons / our rectangles", "Detour, thousand queries/s", "throng", "ratio",
            "reached, Detour / throng", "Detour's paths that are legal / of these, not found by us", "length, ours / Detour's",
            "max length / a legal one of Detour's", "to make ours")
    rows = [row(*run, options) for run in RUNS]
    text = f"Machine: {machine()}. {options.runs} alternating runs; median (smallest to largest), one thread.\n\n" + table(head, rows)
    write_between("detour_table", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
