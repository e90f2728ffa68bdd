# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Repeats figures 3 and 4 of [TC00], then the same a hundred times larger, and measures fill rate.

Writes the tables into docs/results.md and the charts into docs/images. `--quick`: few points and frames, into
build/results alone, to see that it works.

scripts/results figures [--runs N] [--quick] [--only small|large|fill]"""
import argparse
import os
import sys

from results_page import ROOT, WORK, machine, run_json, say, table, write_between

BENCH = ROOT / "build/release/bench/bench_figures"
CITY = 2368  # Polygons of figure 3.
SMALL = {"name": "figures", "scale": 1, "size": 316,
         "avatars": [0, 1000, 2000, 3000, 4000, 5000, 6000, 7000, 8000, 9000, 10_000],
         "polygons": [267, 2368, 8000, 16_000, 24_000, 32_128]}
LARGE = {"name": "figures_large", "scale": 100, "size": 3160,
         "avatars": [0, 100_000, 200_000, 400_000, 600_000, 800_000, 1_000_000],
         "polygons": [26_700, 236_800, 800_000, 1_600_000, 3_212_800]}
CURVES = [("collision and impostors", "#b5432b", "textured"), ("collision", "#3b6ea5", "collision"), ("plain", "#7a7a72", "plain")]
FILL = [5, 10, 20, 40, 80]  # [m]


def number(value):
    return f"{value:,}".replace(",", " ")


def ms(value):
    return f"{value:.1f}"


def measure(*words):
    priority = ["nice", "-n", "-5"] if os.geteuid() == 0 else []
    return run_json(*priority, BENCH, *words)


def nice_step(largest, parts):
    """A step of 1, 2 or 5 times a power of ten: at most `parts` of them reach `largest`."""
    step = 1
    while True:
        for factor in (1, 2, 5):
            if largest <= factor * step * parts:
                return factor * step
        step *= 10


def chart(path, title, x_title, rows, key):
    """Lines over two linear axes from 0, as the figures have them."""
    width, height, left, top, right, bottom = 760, 460, 78, 46, 40, 58
    x_step, y_step = (nice_step(max(largest, 1), 6) for largest in
                      (max(row[key] for row in rows), max(row[f"min_{what}"] for row in rows for _, _, what in CURVES)))
    x_max = max(row[key] for row in rows)
    y_max = y_step * -(-max(row[f"min_{what}"] for row in rows for _, _, what in CURVES) // y_step)

    def at(x, y):
        return left + x / x_max * (width - left - right), height - bottom - y / y_max * (height - top - bottom)

    text = "font-family='sans-serif' fill='#333'"
    out = [f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' viewBox='0 0 {width} {height}'>",
           f"<rect width='{width}' height='{height}' fill='#fff'/>",
           f"<text x='{left}' y='26' font-size='16' {text}>{title}</text>"]
    for k in range(int(y_max / y_step + 0.5) + 1):
        x, y = at(0, k * y_step)
        out.append(f"<line x1='{x:.1f}' y1='{y:.1f}' x2='{width - right}' y2='{y:.1f}' stroke='#ddd'/>"
                   f"<text x='{x - 8:.1f}' y='{y + 4:.1f}' font-size='12' text-anchor='end' {text}>{number(k * y_step)}</text>")
    for k in range(int(x_max / x_step) + 1):
        x, y = at(k * x_step, 0)
        out.append(f"<line x1='{x:.1f}' y1='{top}' x2='{x:.1f}' y2='{y:.1f}' stroke='#eee'/>"
                   f"<text x='{x:.1f}' y='{y + 18:.1f}' font-size='12' text-anchor='middle' {text}>{number(k * x_step)}</text>")
    for n, (name, colour, what) in enumerate(CURVES):
        points = [at(row[key], row[f"min_{what}"]) for row in rows]
        line = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        out.append(f"<polyline points='{line}' fill='none' stroke='{colour}' stroke-width='2.5'/>")
        out += [f"<circle cx='{x:.1f}' cy='{y:.1f}' r='3.5' fill='{colour}'/>" for x, y in points]
        out.append(f"<rect x='{left + 14}' y='{top + 6 + 20 * n}' width='14' height='4' fill='{colour}'/>"
                   f"<text x='{left + 34}' y='{top + 12 + 20 * n}' font-size='13' {text}>{name}</text>")
    out.append(f"<text x='{(left + width - right) / 2}' y='{height - 14}' font-size='13' text-anchor='middle' {text}>{x_title}</text>"
               f"<text x='20' y='{(top + height - bottom) / 2}' font-size='13' text-anchor='middle' {text} "
               f"transform='rotate(-90 20 {(top + height - bottom) / 2})'>milliseconds a frame</text></svg>")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(out) + "\n")
    say(f"wrote {path.relative_to(ROOT)}")


def line(points):
    """Least squares of y over x: the slope, the value at 0, and the share of the variance that the line explains."""
    count = len(points)
    mean_x, mean_y = (sum(values) / count for values in zip(*points))
    var_x, var_y = (sum((v - mean) ** 2 for v in values) for values, mean in zip(zip(*points), (mean_x, mean_y)))
    both = sum((x - mean_x) * (y - mean_y) for x, y in points)
    return both / var_x, mean_y - both / var_x * mean_x, both**2 / (var_x * var_y) if var_y > 0 else 1.0


def rows_of(report, key):
    return [(number(row[key]), *(ms(row[f"min_{what}"]) for what in ("plain", "collision", "textured", "detail", "step")), row["faults"])
            for row in report]


def fits(report, key):
    unit = 1000
    words = []
    for name, _, what in CURVES:
        slope, _, share = line([(row[key], row[f"min_{what}"]) for row in report])
        words.append(f"{name} {slope * unit:.2g} ms (R2 {share:.3f})")
    return f"For each 1 000 {key} more, by least squares: " + "; ".join(words) + "."


def section(plan, runs, folder):
    """Figures 3 and 4 at one scale. `folder`: of the charts; the text is returned."""
    scale, size = plan["scale"], plan["size"]
    common = ("--size", size, "--runs", runs)
    by_avatars = [measure("--avatars", n, "--polygons", CITY * scale, *common) for n in plan["avatars"]]
    by_polygons = [measure("--avatars", 10_000 * scale, "--polygons", n, *common) for n in plan["polygons"]]
    charts = [f"{plan['name']}_avatars.svg", f"{plan['name']}_polygons.svg"]
    chart(folder / charts[0], f"[TC00] figure 3: {number(CITY * scale)} polygons", "avatars", by_avatars, "avatars")
    chart(folder / charts[1], f"[TC00] figure 4: {number(10_000 * scale)} avatars", "polygons", by_polygons, "polygons")
    head = ("plain [ms]", "collision [ms]", "collision and impostors [ms]", "with levels of detail [ms]", "of it the step [ms]", "faults")
    return "\n\n".join([
        f"Machine: {machine()}; {by_avatars[0]['renderer']}, 1280 x 720, one sample a pixel. City of {size} m. Minimum of {runs} "
        f"frames of each kind, in turn. Load of the machine at the start: {os.getloadavg()[0]:.1f}.",
        table((f"avatars, {number(CITY * scale)} polygons", *head), rows_of(by_avatars, "avatars")),
        fits(by_avatars, "avatars"),
        table((f"polygons, {number(10_000 * scale)} avatars", *head), rows_of(by_polygons, "polygons")),
        fits(by_polygons, "polygons"),
        f"![Figure 3](images/{charts[0]})\n\n![Figure 4](images/{charts[1]})"])


def fill(runs, distances):
    rows = []
    for metres in distances:
        found = measure("--fill", metres, "--runs", runs)
        rows.append((metres, f"{found['view_pixels']:.0f}", number(found["avatars"]), f"{found['pixels_packed']:.0f}", f"{found['pixels_square']:.0f}",
                     f"{found['pixels_packed'] / found['pixels_square']:.2f}", ms(found["min_empty"]), ms(found["min_packed"]), ms(found["min_square"]),
                     f"{(found['min_packed'] - found['min_empty']) / max(found['min_square'] - found['min_empty'], 1e-9):.2f}",
                     f"{100 * found['differing_share']:.2f} %"))
    head = ("distance [m]", "side of a view [px]", "avatars", "pixels shaded an avatar, packed", "in squares", "packed / squares", "no avatar [ms]",
            "packed [ms]", "squares [ms]", "time of avatars, packed / squares", "channels of the picture that differ")
    return f"Machine: {machine()}. Minimum of {runs} frames of each kind, in turn.\n\n" + table(head, rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--quick", action="store_true", help="few points, nothing in docs")
    parser.add_argument("--only", choices=("small", "large", "fill"))
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    folder = WORK if options.quick else ROOT / "docs/images"
    runs = min(options.runs, 3) if options.quick else options.runs

    def publish(marker, text):
        if options.quick:
            print(f"## {marker}\n\n{text}\n")
        else:
            write_between(marker, text)

    for kind, plan in (("small", SMALL), ("large", LARGE)):
        if options.only not in (None, kind):
            continue
        if options.quick:
            plan = {**plan, "avatars": plan["avatars"][::5] or plan["avatars"], "polygons": plan["polygons"][::2]}
        publish(f"{plan['name']}_table", section(plan, runs, folder))
    if options.only in (None, "fill"):
        publish("fill_table", fill(runs, FILL[::2] if options.quick else FILL))
    say("done")
    return 0


if __name__ == "__main__":
    sys.exit(main())
