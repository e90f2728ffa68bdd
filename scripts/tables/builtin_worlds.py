# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Generates every built-in world at its default size and writes its sizes, limits and counts into docs/builtin_worlds.md.

scripts/results builtin_worlds"""
import argparse

from results_page import PROGRAM, WORK, run_json, table, write_between

PAPER = {"cube", "garage", "church", "powerplant"}  # Of [ML06] table 2.


def metres(number):
    """Without zeros at the end: 5.8, 85.125."""
    return f"{number:.3f}".rstrip("0").rstrip(".")


def levels(info):
    return "{default_levels} (1 to {max_levels})".format(**info) if info["max_levels"] else ""


def row(info):
    name = info["name"]
    made = run_json(PROGRAM, "generate", name, "-o", WORK / f"{name}.glb", "--json")
    # How many slices are taken does not depend on the cell.
    taken = run_json(PROGRAM, "slices", f"builtin:{name}", "--cell", 1, "--json")["taken"] if name in PAPER else ""
    return (name, metres(info["default_size"]), f"{metres(info['min_size'])} to {metres(info['max_size'])}", levels(info),
            metres(made["extent"][1]), f"{made['triangles']:,}".replace(",", " "), taken)


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    listed = run_json(PROGRAM, "generate", "--list", "--json")["worlds"]
    text = table(["name", "default size [m]", "limits [m]", "levels", "height [m]", "triangles", "slices taken"],
                 [row(info) for info in listed])
    write_between("builtin_worlds_table", "\n" + text + "\n", page="docs/builtin_worlds.md")


main()
