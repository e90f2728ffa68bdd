# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Checks paths over level tiles between random pairs in every world: legal moves, and bodies against all triangles.

scripts/results paths [--pairs N] [--only TEXT] [--threads T]"""
import argparse
import shutil
import sys

from all_worlds import worlds
from results_page import PROGRAM, WORK, machine, run_json, table, write_between

CLASSES = 4  # The default ones.
COUNTS = ("pairs", "reached", "disconnected", "segments", "bodies", "illegal", "entered", "unsupported", "broken", "disagree")
FAULTS = COUNTS[5:]


def row_of(name, model, words, options):
    folder = WORK / "paths.throng"
    run_json(PROGRAM, "bake", model, *words, "-o", folder, "--rebuild", "--cell", 0.1, "--threads", options.threads, "--json")
    found = run_json(PROGRAM, "verify", folder, "--source", model, *words, "--paths", "--samples",
                     -(-options.pairs // CLASSES), "--threads", options.threads, "--json")["classes"]
    shutil.rmtree(folder)
    sums = {key: sum(entry[key] for entry in found) for key in COUNTS}
    length, straight = (sum(entry[key] for entry in found) for key in ("length", "straight"))
    return sums, (name, f"{sums['pairs']:,}", f"{sums['reached']:,}", f"{sums['segments']:,}", f"{sums['bodies']:,}",
                  f"{length / sums['reached']:.0f}" if sums["reached"] else "",
                  f"{length / straight:.3f}" if straight else "",
                  *(sums[fault] for fault in FAULTS))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", default=10_000, type=int, help="in each world, over all its classes")
    parser.add_argument("--only", default="", help="worlds whose name has this text; prints, writes nothing")
    parser.add_argument("--threads", default=0, type=int)
    options = parser.parse_args()
    rows, total = [], dict.fromkeys(COUNTS, 0)
    for name, model, words in worlds():
        if options.only not in name:
            continue
        sums, row = row_of(name, model, words, options)
        rows.append(row)
        total = {key: total[key] + sums[key] for key in COUNTS}
    faults = sum(total[fault] for fault in FAULTS)
    text = (f"Machine: {machine()}. {total['pairs']:,} pairs on {len(rows)} worlds, cells of 0.1 m, four classes: {total['reached']:,} with a path, "
            f"{total['disconnected']:,} in different components; {total['bodies']:,} bodies on the paths; {faults} faults (target 0): "
            f"{'met' if faults == 0 else 'MISSED'}.\n\n")
    text += table(["world", "pairs", "reached", "segments", "bodies on them", "mean length [m]", "length / straight line", *FAULTS], rows)
    if options.only:
        print(text)
    else:
        write_between("paths_table", text)
    return 0 if faults == 0 else 1


sys.exit(main())
