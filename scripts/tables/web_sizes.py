#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Writes the sizes of the page's files into docs/web.md, or checks what is written there. Needs the page: scripts/web.

scripts/results web_sizes [--check] [--site FOLDER]: with --check writes nothing, and fails where a size differs by over 5 %."""
import argparse
import gzip
import pathlib
import sys

from results_page import ROOT, rows_between, table, write_between

PAGE = "docs/web.md"
FILES = (("throng_web.wasm", "the program"), ("throng_web.js", "what loads it"),
         ("people.atlas", "the avatars' pictures, compressed for cards of desktops"),
         ("people_etc2.atlas", "the same for cards of phones, fetched instead"), ("panel.ttf", "the panel's font"))
TOLERANCE = 0.05


def megabytes(size):
    return f"{size / 1e6:.2f} MB"


def measured(site):
    for name, what in FILES:
        path = site / name
        if not path.is_file():
            sys.exit(f"web_sizes: {path} is missing; scripts/web makes it")
        data = path.read_bytes()
        yield f"`{name}`", what, megabytes(len(data)), megabytes(len(gzip.compress(data, 6)))


def faults(rows):
    written = {row[0]: row[2:] for row in rows_between("web_sizes", PAGE)}
    for name, _, *sizes in rows:
        if name not in written:
            yield f"{name} is not in {PAGE}"
            continue
        for now, then in zip(sizes, written[name]):
            a, b = float(now.split()[0]), float(then.split()[0])
            if abs(a - b) > max(TOLERANCE * b, 0.011):
                yield f"{name}: {now}, and {PAGE} says {then}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--site", type=pathlib.Path, default=ROOT / "build/web/site")
    options = parser.parse_args()
    rows = list(measured(options.site))
    if not options.check:
        write_between("web_sizes", table(("file", "what", "size", "as gzip"), rows), PAGE)
        return 0
    found = list(faults(rows))
    for fault in found:
        print(f"web_sizes: {fault}; scripts/results web_sizes writes the table again", file=sys.stderr)
    print(f"web_sizes: {len(rows)} files, {len(found)} faults")
    return 1 if found else 0


sys.exit(main())
