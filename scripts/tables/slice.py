# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Cuts the worlds of [ML06] Table 2 and every model of ../shared/worlds into slices: counts, bytes and times.

Then Table 2 over cells of 0.1 to 2 m: the paper does not print its own.

scripts/results slice [--only PART_OF_NAME] [--cells]    --cells: the second table alone"""
import argparse
import json
import subprocess

from results_page import PROGRAM, WORLDS, human, machine, say, table, write_between

# [ML06] Table 2: taken, kept.
PAPER = {"builtin:cube": (42, 2), "builtin:garage": (86, 5), "builtin:church": (159, 7),
         "builtin:powerplant": (835, 85)}
MODELS = {".obj", ".dae", ".ifc", ".glb", ".gltf", ".ply", ".stl", ".fbx", ".json", ".gml", ".bsp", ".zonel", ".bpt"}
FOLDERS = ["bezier", "buildings", "cities", "quake3", "recast", "sponza"]
# What a format does not say. Quake units are inches.
OPTIONS = {"buildings/wd1_psup.obj": ("--up", "z"), "cities/denhaag_01.obj": ("--up", "z"),
           "cities/lod3_railway.obj": ("--up", "z"), ".bsp": ("--scale", "0.0254")}
CELLS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 50]
TABLE_2_CELLS = [0.1, 0.2, 0.5, 1, 2]
MAX_CELLS = 2_000_000  # A kept slice is a full grid, so larger worlds get larger cells.


def slices(source, cell):
    options = next((OPTIONS[key] for key in OPTIONS if str(source).endswith(key)), ())
    command = [str(word) for word in (PROGRAM, "slices", source, *options, "--cell", cell, "--json")]
    say("$ " + " ".join(command))
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=1200)
    if done.returncode != 0:
        return {"error": (done.stderr.strip().splitlines() or ["no reason given"])[-1]}
    return json.loads(done.stdout)


def cell_for(coarse):
    area = coarse["width"] * coarse["depth"] * coarse["cell"] ** 2
    return next(cell for cell in CELLS if area / cell ** 2 <= MAX_CELLS or cell == CELLS[-1])


def row(name, source):
    """A row, or None for a format that the program does not read."""
    report = slices(source, 1 if source in PAPER else 5)
    if "unknown kind" in report.get("error", ""):
        say(f"left out: {report['error']}")
        return None
    if "error" not in report:
        report = slices(source, cell_for(report))
    paper = "{} / {}".format(*PAPER[source]) if source in PAPER else "-"
    if "error" in report:
        return (name, "", "", "", "refused: " + report["error"].removeprefix("throng: ").replace(f"{WORLDS}/", ""), paper, "", "", "")
    size = "{:.0f} x {:.0f} m".format(report["width"] * report["cell"], report["depth"] * report["cell"])
    return (name, report["triangles"], size, report["cell"], f"{report['taken']} / {report['kept']}", paper,
            human(report["bytes"]), f"{report['seconds']:.2f}", human(report["peak_bytes"]))


def by_cell(source, paper):
    """Kept slices at each cell, and at which cells they come nearest to the paper's."""
    kept = [slices(source, cell)["kept"] for cell in TABLE_2_CELLS]
    least = min(abs(count - paper[1]) for count in kept)
    nearest = [f"{cell:g}" for cell, count in zip(TABLE_2_CELLS, kept) if abs(count - paper[1]) == least]
    return (source.removeprefix("builtin:"), paper[1], *kept, " and ".join(nearest))


def write_cells():
    rows = [by_cell(source, paper) for source, paper in PAPER.items()]
    write_between("slice_cells_table", table(["world", "[ML06] kept", *(f"cells of {cell:g} m" for cell in TABLE_2_CELLS),
                                              "nearest at [m]"], rows))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="")
    parser.add_argument("--cells", action="store_true")
    options = parser.parse_args()
    only = options.only
    write_cells()
    if options.cells:
        return
    sources = [(source.removeprefix("builtin:"), source) for source in PAPER]
    if WORLDS.is_dir():
        found = sorted(path for folder in FOLDERS for path in (WORLDS / folder).rglob("*") if path.suffix in MODELS)
        sources += [(str(path.relative_to(WORLDS)), path) for path in found]
        # One zone of the landscape stands for its 96: they are baked together elsewhere.
        sources += [(str(path.relative_to(WORLDS)), path) for path in sorted((WORLDS / "nel").glob("*.zonel"))[:1]]
    rows = [line for name, source in sources if only in name and (line := row(name, source)) is not None]
    text = (f"Machine: {machine()}. Avatar 1.75 m, resolution 0.1 m, all threads. Cells of 0.1 m where that gives at most "
            f"{MAX_CELLS / 1e6:g} million, else larger. Bytes: kept slices with 16-bit depths where they fit. Seconds: columns "
            "and all cuts, without reading the model.\n\n")
    text += table(["world", "triangles", "size", "cell [m]", "taken / kept", "[ML06]", "bytes", "seconds", "peak memory"],
                  rows)
    write_between("slice_table", text)


main()
