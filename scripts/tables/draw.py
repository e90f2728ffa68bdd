# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Times frames of a city with avatars, beside plain quads, and by polygons and avatars as in [TC00] figures 3 and 4.

Writes the tables into docs/results.md and the charts into docs/images.

scripts/results draw [--runs N] [--quick] [--growth] [--street]    --quick: no chart beyond 100 000"""
import argparse
import math
import os
import sys

from results_page import ROOT, machine, run_json, say, table, write_between

BENCH = ROOT / "build/release/bench/bench_draw"
MAX_RATIO = 1.3
CITY = 30_000
PEOPLE, QUADS, EMPTY = "#b5432b", "#3b6ea5", "#7a7a72"


def measure(avatars, polygons, runs, *more):
    priority = ["nice", "-n", "-5"] if os.geteuid() == 0 else []
    return run_json(*priority, BENCH, "--avatars", avatars, "--polygons", polygons, "--runs", runs, *more)


def ms(value):
    return f"{value:.1f}"


def slope(points):
    """Least squares of log time over log size."""
    logs = [(math.log(x), math.log(y)) for x, y in points if y > 0]
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / sum((x - mean_x) ** 2 for x, _ in logs)


def alone(report):
    """Time that people add to a frame / time that quads add, where the latter is more than a tenth of the frame."""
    added = report["ms_quads"] - report["ms_empty"]
    return f"{(report['ms_people'] - report['ms_empty']) / added:.2f}" if added > 0.1 * report["ms_quads"] else "too little to measure"


def number(value):
    return f"{value:,}".replace(",", " ")


def chart(path, title, x_title, curves):
    """Lines over two logarithmic axes, as SVG. curves: (name, colour, [(x, ms)])."""
    width, height, left, top, right, bottom = 760, 460, 78, 46, 40, 58
    every = [p for _, _, points in curves for p in points]
    x0, x1 = (f(math.log10(x) for x, _ in every) for f in (min, max))
    y0, y1 = math.floor(min(math.log10(y) for _, y in every)), math.ceil(max(math.log10(y) for _, y in every))

    def at(x, y):
        return (left + (math.log10(x) - x0) / (x1 - x0) * (width - left - right),
                height - bottom - (math.log10(y) - y0) / (y1 - y0) * (height - top - bottom))

    text = "font-family='sans-serif' fill='#333'"
    out = [f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' viewBox='0 0 {width} {height}'>",
           f"<rect width='{width}' height='{height}' fill='#fff'/>",
           f"<text x='{left}' y='26' font-size='16' {text}>{title}</text>"]
    for k in range(y0, y1 + 1):
        x, y = at(10 ** x0, 10 ** k)
        out.append(f"<line x1='{x:.1f}' y1='{y:.1f}' x2='{width - right}' y2='{y:.1f}' stroke='#ddd'/>"
                   f"<text x='{x - 8:.1f}' y='{y + 4:.1f}' font-size='12' text-anchor='end' {text}>{10 ** k:g}</text>")
    for value in sorted({x for x, _ in every}):
        x, y = at(value, 10 ** y0)
        out.append(f"<line x1='{x:.1f}' y1='{top}' x2='{x:.1f}' y2='{y:.1f}' stroke='#eee'/>"
                   f"<text x='{x:.1f}' y='{y + 18:.1f}' font-size='12' text-anchor='middle' {text}>{number(value)}</text>")
    for n, (name, colour, points) in enumerate(curves):
        line = " ".join(f"{x:.1f},{y:.1f}" for x, y in (at(*p) for p in points))
        out.append(f"<polyline points='{line}' fill='none' stroke='{colour}' stroke-width='2.5'/>")
        out += [f"<circle cx='{x:.1f}' cy='{y:.1f}' r='3.5' fill='{colour}'/>" for x, y in (at(*p) for p in points)]
        out.append(f"<rect x='{left + 14}' y='{top + 6 + 20 * n}' width='14' height='4' fill='{colour}'/>"
                   f"<text x='{left + 34}' y='{top + 12 + 20 * n}' font-size='13' {text}>{name}</text>")
    out.append(f"<text x='{(left + width - right) / 2}' y='{height - 14}' font-size='13' text-anchor='middle' {text}>{x_title}</text>"
               f"<text x='20' y='{(top + height - bottom) / 2}' font-size='13' text-anchor='middle' {text} "
               f"transform='rotate(-90 20 {(top + height - bottom) / 2})'>milliseconds a frame</text></svg>")
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(out) + "\n")
    say(f"wrote {path.relative_to(ROOT)}")


def beside_quads(runs):
    rows, met, renderer, load = [], True, "", os.getloadavg()[0]
    for avatars in (10_000, 100_000, 1_000_000):
        report = measure(avatars, CITY, runs)
        views = measure(avatars, CITY, max(3, runs // 3), "--point-pixels", 0)
        shadows = measure(avatars, CITY, max(3, runs // 3), "--shadows")
        renderer = report["renderer"]
        met = met and report["ratio"] <= MAX_RATIO
        rows.append((number(avatars), number(report["seen"]), ms(report["ms_quads"]), ms(report["ms_people"]), ms(report["ms_empty"]),
                     f"**{report['ratio']:.2f}**: {'met' if report['ratio'] <= MAX_RATIO else 'MISSED'}", alone(report),
                     f"{views['ratio']:.2f}", f"{shadows['ratio']:.2f}", ms(report["ms_pack"])))
    head = ("avatars", "drawn", "plain quads [ms]", "people [ms]", "no avatar [ms]", f"people / quads, <= {MAX_RATIO}", "without the city's share",
            "views alone, no points", "with shadows of avatars", "cull and pack, 2 threads [ms]")
    write_between("draw_table", f"Machine: {machine()}; {renderer}, 1280 x 720, one sample a pixel. Medians of {runs} frames of each kind, in turn, in one run. Load of the machine at the start: {load:.1f}.\n\n" + table(head, rows))
    return met


def street(runs):
    rows = []
    for avatars, polygons in ((100_000, CITY), (1_000_000, 300_000), (10_000, 3_000_000)):
        report = measure(avatars, polygons, runs, "--street")
        rows.append((number(report["avatars"]), number(report["triangles"]), f"{number(report['seen'])} / {number(report['hidden'])}",
                     f"{number(report['triangles_seen'])} / {number(report['triangles_drawn'])}", ms(report["ms_all"]), ms(report["ms_people"]),
                     f"{report['ms_all'] / report['ms_people']:.2f}", ms(report["ms_empty"])))
    head = ("avatars", "triangles", "in the frustum / hidden", "triangles in the frustum / drawn", "all of it drawn [ms]", "without what is hidden [ms]", "times faster", "no avatar [ms]")
    write_between("draw_street_table", f"Medians of {runs} frames of each kind, in turn. Load of the machine at the start: {os.getloadavg()[0]:.1f}.\n\n" + table(head, rows))


def growth(runs, quick):
    counts = [1_000, 3_000, 10_000, 30_000, 100_000] + ([] if quick else [300_000, 1_000_000])
    sizes = [3_000, 10_000, 30_000, 100_000, 300_000] + ([] if quick else [1_000_000, 3_000_000])
    by_avatars = [measure(n, CITY, runs) for n in counts]
    by_polygons = [measure(10_000, n, runs) for n in sizes]

    def curves(report, key):
        return [(name, colour, [(row[key], row[f"least_{what}"]) for row in report])
                for name, colour, what in (("people", PEOPLE, "people"), ("plain quads", QUADS, "quads"), ("no avatar", EMPTY, "empty"))]

    chart(ROOT / "docs/images/draw_avatars.svg", f"Time against avatars; a city of {number(by_avatars[0]['triangles'])} triangles", "avatars",
          curves(by_avatars, "avatars"))
    chart(ROOT / "docs/images/draw_polygons.svg", "Time against polygons of the city; 10 000 avatars", "triangles", curves(by_polygons, "triangles"))
    added = [(row["avatars"], row["least_people"] - row["min_empty"]) for row in by_avatars if row["avatars"] >= 30_000]
    large = [(row["triangles"], row["min_empty"]) for row in by_polygons if row["triangles"] >= 100_000]
    rows = [(number(row["avatars"]), ms(row["least_people"]), ms(row["least_quads"]), ms(row["min_empty"])) for row in by_avatars]
    more = [(number(row["triangles"]), ms(row["least_people"]), ms(row["least_quads"]), ms(row["min_empty"])) for row in by_polygons]
    text = [f"Minimum of {runs} frames: other load on the machine only adds.", table(("avatars", "people [ms]", "plain quads [ms]", "no avatar [ms]"), rows)]
    if len(added) > 1:
        text.append(f"What the avatars add grows from 30 000 on with the power {slope(added):.2f} of their number.")
    text.append(table(("triangles", "10 000 people [ms]", "plain quads [ms]", "no avatar [ms]"), more))
    if len(large) > 1:
        text.append(f"The city's time grows from 100 000 triangles on with the power {slope(large):.2f} of their number; below that, pixels take it.")
    text.append("![Time against avatars](images/draw_avatars.svg)\n\n![Time against polygons](images/draw_polygons.svg)")
    write_between("draw_growth_table", "\n\n".join(text))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--growth", action="store_true", help="only the second table and the charts")
    parser.add_argument("--street", action="store_true", help="only what is seen from a street")
    options = parser.parse_args()
    if options.street:
        street(options.runs)
        return 0
    met = options.growth or beside_quads(options.runs)
    if not options.growth:
        street(options.runs)
    growth(options.runs, options.quick)
    say("done")
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
