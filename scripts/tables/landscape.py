# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bakes and verifies curved ground: the real landscape in ../shared/worlds/nel and built-in ones.

scripts/results landscape [--threads T] [--samples N]"""
import argparse
import shutil
import time

from results_page import PROGRAM, WORK, WORLDS, human, machine, run_json, table, write_between

ZONE = 160  # The side of a zone of [PACS00]. [m]
MAX_MS = 50  # A zone of the real landscape at 0.25 m cells. [ms]
REAL_ZONES = 96
RUNS = 5  # The median is taken.


def worlds():
    """Name, model, zones, cell, options of the bake."""
    if (WORLDS / "nel").exists():
        for cell in (0.25, 0.5):
            yield "nel", WORLDS / "nel", REAL_ZONES, cell, []
        yield "nel, with nodes of 1 m", WORLDS / "nel", REAL_ZONES, 0.25, ["--nodes"]
    for side in (320, 1000, 2000):
        yield f"landscape, {side} m", f"builtin:landscape,size={side}", side * side / ZONE**2, 0.25, []


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--threads", default=2, type=int)
    parser.add_argument("--samples", default=5000, type=int)
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    rows = []
    verdict = ""
    for name, model, zones, cell, words in worlds():
        folder = WORK / "landscape.throng"
        runs = []
        for _ in range(RUNS):
            start = time.monotonic()
            bake = run_json(PROGRAM, "bake", model, *words, "-o", folder, "--rebuild", "--cell", cell, "--threads", options.threads, "--json")
            runs.append((time.monotonic() - start, bake))
        whole, bake = sorted(runs, key=lambda run: run[0])[RUNS // 2]
        proof = run_json(PROGRAM, "verify", folder, "--source", model, "--samples", options.samples, "--json")
        shutil.rmtree(folder)
        if name.startswith("nel") and cell == 0.25:
            met = "met" if whole * 1000 / zones <= MAX_MS else "MISSED"
            verdict += (f"\n\nThe {zones} real zones at {cell} m cells{name[3:]}, with reading: {whole * 1000 / zones:.0f} ms a zone, "
                        f"target <= {MAX_MS}: {met}.")
        rows.append((name, cell, bake["patches"], bake["triangles"], f"{whole - bake['seconds_total']:.2f}",
                     f"{bake['seconds_total']:.2f}", f"{whole * 1000 / zones:.0f}", human(bake["bytes"]),
                     human(bake["peak_bytes"]), f"{proof['entered']} / {proof['unsupported']} / {proof['broken']}"))
    text = (f"Machine: {machine()}. Four classes, {options.threads} threads, {options.samples} samples a class and "
            f"kind; zones of 160 m; median of {RUNS} runs.\n\n")
    text += table(["world", "cell [m]", "patches", "triangles", "read, tessellate and make nodes [s]", "bake [s]", "whole, ms a zone", "bytes",
                   "peak memory", "entered / unsupported / broken"], rows)
    write_between("landscape_table", text + verdict)


main()
