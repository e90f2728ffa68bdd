# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bakes cities of 1, 4 and 16 square kilometres and the largest powerplant: time, bytes and memory by area.

scripts/results linear [--threads T]"""
import argparse
import shutil

from results_page import PROGRAM, WORK, human, machine, run_json, table, write_between

SIDES = [1000, 2000, 4000]  # [m]
TOLERANCE = 0.15
LARGEST = 12_700_000  # Triangles requested of the powerplant.
MAX_MEMORY = 4 << 30  # [bytes]


def largest_text(threads):
    """The powerplant is read from a file, as any model is."""
    model, folder = WORK / "powerplant.glb", WORK / "powerplant.throng"
    run_json(PROGRAM, "generate", "powerplant", "--triangles", LARGEST, "-o", model, "--json")
    report = run_json(PROGRAM, "bake", model, "-o", folder, "--rebuild", "--threads", threads, "--json")
    model.unlink()
    shutil.rmtree(folder)
    verdict = "met" if report["peak_bytes"] < MAX_MEMORY else "MISSED"
    return (f"\n\nThe largest powerplant, {report['triangles']} triangles at 0.1 m cells, read from its GLB: {report['seconds_total']:.1f} s of "
            f"bake, {human(report['bytes'])} of zones, {human(report['peak_bytes'])} of memory at the peak, target under "
            f"{human(MAX_MEMORY)}: {verdict}.")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--threads", default=2, type=int)
    parser.add_argument("--cell", default=0.1, type=float)
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    rows = []
    rates = []
    for side in SIDES:
        folder = WORK / "city.throng"
        report = run_json(PROGRAM, "bake", f"builtin:city,size={side}", "-o", folder, "--rebuild", "--cell", options.cell,
                          "--threads", options.threads, "--json")
        shutil.rmtree(folder)
        area = side * side / 1e6
        rates.append((report["seconds_total"] / area, report["bytes"] / area,
                      report["peak_bytes"] - report["peak_bytes_read"]))
        rows.append((f"{area:g}", report["triangles"], f"{report['seconds_total']:.1f}", human(report["bytes"]),
                     f"{rates[-1][0]:.2f}", human(rates[-1][1]), human(report["peak_bytes_read"]),
                     human(report["peak_bytes"]), human(rates[-1][2])))
    seconds = [rate[0] / rates[0][0] - 1 for rate in rates]
    size = [rate[1] / rates[0][1] - 1 for rate in rates]
    text = f"Machine: {machine()}. Cell {options.cell} m, four classes, {options.threads} threads.\n\n"
    text += table(["km2", "triangles", "seconds", "bytes", "s / km2", "bytes / km2", "memory with the scene read",
                   "peak memory", "of it the bake's"], rows)
    for name, drift in (("time", seconds), ("bytes", size)):
        worst = max(drift, key=abs)
        text += (f"\n\n{name.capitalize()} for each km2 against the smallest city's: {worst * 100:+.1f} % at most, "
                 f"target within {TOLERANCE * 100:.0f} %: {'met' if abs(worst) <= TOLERANCE else 'MISSED'}.")
    text += largest_text(options.threads)
    write_between("linear_table", text)


main()
