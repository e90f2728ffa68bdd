# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Times levels of detail: the random scene seen whole and through one view, alternating.

scripts/results detail [--runs N] [--threads T] [--avatars N...]"""
import argparse
import statistics

from results_page import ROOT, machine, run_json, table, write_between

CROWD = ROOT / "build/release/bench/bench_crowd"
DT = 0.05  # [s]
# Share of the crowd in view, and how many steps an avatar out of view covers at once.
VIEWS = ((0.1, 1), (0.1, 4), (0.01, 1), (0.01, 4))


def spread(values, digits):
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def rows(avatars, area, runs, threads):
    common = ("--avatars", avatars, "--area", area, "--dt", DT, "--threads", threads, "--steps", 100)
    side = (area * avatars) ** 0.5
    whole, parts = [], {view: [] for view in VIEWS}
    for _ in range(runs):
        whole.append(run_json(CROWD, *common))
        for view in VIEWS:
            radius = side * (view[0] / 3.14159265) ** 0.5
            parts[view].append(run_json(CROWD, *common, "--view", f"{radius:.1f}", "--far-steps", view[1]))
    faults = sum(r["overlaps"] + r["wall_entries"] for r in whole)
    yield avatars, area, "all", "", "0 %", spread([r["ns"] for r in whole], 0), "1", f"{whole[-1]['progress']:.3f}", faults
    for (share, steps), found in parts.items():
        last = found[-1]
        ratios = [a["ns"] / b["ns"] for a, b in zip(whole, found)]
        yield (avatars, area, f"{100 * share:g} %", steps, f"{100 * last['held']:.0f} %", spread([r["ns"] for r in found], 0), spread(ratios, 2),
               f"{last['progress']:.3f}", sum(r["overlaps"] + r["wall_entries"] for r in found))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--avatars", type=int, nargs="+", default=[10_000, 100_000])
    options = parser.parse_args()
    found = [row for avatars in options.avatars for area in (4, 1) for row in rows(avatars, area, options.runs, options.threads)]
    head = ("avatars", "m2 each", "in view", "steps at once, max", "skipped", "ns an avatar a step", "times as fast", "progress", "overlaps and walls entered")
    text = (f"Machine: {machine()}. {options.threads} thread(s), dt {DT} s, {options.runs} runs, median (min to max); ratios of consecutive runs.\n\n")
    write_between("detail_table", text + table(head, found))


if __name__ == "__main__":
    main()
