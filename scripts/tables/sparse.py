# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bytes and look-up times of full grids of slices, sparse slices and level tiles, over worlds of all kinds.

scripts/results sparse [--lookups N]"""
import argparse

from results_page import ROOT, WORLDS, human, machine, run_json, table, write_between

BENCH = ROOT / "build/release/bench/bench_slices"
# World, side of a cell, options of the reader.
CASES = [("builtin:cube", 0.1), ("builtin:garage", 0.1), ("builtin:church", 0.1), ("builtin:powerplant", 0.1),
         ("buildings/duplex_arch.obj", 0.1), ("buildings/office_a.obj", 0.1), ("recast/dungeon.obj", 0.1),
         ("recast/nav_test.obj", 0.1), ("sponza/sponza.obj", 0.1), ("recast/city400.obj", 0.5)]


def row(name, cell, lookups):
    source = name if name.startswith("builtin:") else WORLDS / name
    report = run_json(BENCH, source, "--cell", cell, "--lookups", lookups)

    def times(order):
        return " / ".join(f"{report[f'{kind}_ns_{order}']:.1f}" for kind in ("dense", "sparse", "level"))
    return (name.removeprefix("builtin:"), cell, report["slices"],
            *(human(report[f"{kind}_bytes"]) for kind in ("dense", "sparse", "level")), times("random"), times("near"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lookups", default=2_000_000, type=int)
    options = parser.parse_args()
    cases = [(name, cell) for name, cell in CASES if name.startswith("builtin:") or (WORLDS / name).exists()]
    write_between("sparse_table", f"Machine: {machine()}. One thread; a look-up finds the floor of the next cell for a body of 1.75 m that "
                  "knows its own; the fastest of five passes. Level tiles are those of a crowd of adults.\n\n" +
                  table(["world", "cell [m]", "slices", "full grids", "sparse slices", "level tiles",
                         "ns, at random: full / sparse / level", "ns, cell by cell"],
                        [row(name, cell, options.lookups) for name, cell in cases]))


main()
