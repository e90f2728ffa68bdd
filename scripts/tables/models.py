# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Compares the models of steering: quality scenes and tests of `throng validate`.

scripts/results models [--seeds N] [--scenes sparse|dense|circle...] [--tests TEST...]"""
import argparse
import statistics

from results_page import PROGRAM, ROOT, machine, run_json, table, write_between

QUALITY = ROOT / "build/release/bench/bench_quality"
MODELS = ("sampled", "caacd", "social-force")


def spread(values, digits):
    low, high = f"{min(values):.{digits}f}", f"{max(values):.{digits}f}"
    middle = f"{statistics.median(values):.{digits}f}"
    return middle if low == high else f"{middle} ({low} to {high})"


def quality(model, seeds, scenes):
    """Name, target and result, scene by scene."""
    overlaps = 0
    for scene, target in (("sparse", ">= 0.93"), ("dense", ">= 0.50")):
        if scene not in scenes:
            continue
        runs = [run_json(QUALITY, "--scene", scene, "--model", model, "--seed", s) for s in seeds]
        overlaps += sum(r["overlaps"] for r in runs)
        yield f"{scene}: progress", target, spread([r["progress"] for r in runs], 3)
    if "circle" in scenes:
        runs = [run_json(QUALITY, "--scene", "circle", "--bodies", 1000, "--seconds", 150, "--model", model, "--seed", s) for s in seeds]
        overlaps += sum(r["overlaps"] for r in runs)
        yield "circle of 1000: arrived by 150 s", "1000", spread([r["arrived"] for r in runs], 0)
    yield "overlaps in these", "0", overlaps


def validation(model, seeds, tests):
    runs = [run_json(PROGRAM, "validate", *tests, "--model", model, "--seed", s, "--json")["tests"] for s in seeds]
    for n, test in enumerate(runs[0]):
        for k, measure in enumerate(test["measures"]):
            if "low" not in measure and "high" not in measure:
                continue
            values = [r[n]["measures"][k]["value"] for r in runs]
            target = " to ".join(f"{measure[b]:g}" for b in ("low", "high") if b in measure)
            if "high" not in measure:
                target = f">= {target}"
            elif "low" not in measure:
                target = f"<= {target}"
            known = [v for v in values if v is not None]
            text = spread(known, 2) if known else "none"
            yield f"{test['test']}: {measure['name']} {measure['unit']}".rstrip(), target, text + (" or none" if known and len(known) < len(values) else "")
    yield "overlaps and walls entered in these", "0", sum(t["overlaps"] + t["wall_entries"] for r in runs for t in r)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--scenes", nargs="*", default=["sparse", "dense", "circle"])
    parser.add_argument("--tests", nargs="*", default=["fundamental", "bottleneck", "lanes"])
    options = parser.parse_args()
    seeds = range(1, options.seeds + 1)
    found = {}
    for model in MODELS:
        found[model] = list(quality(model, seeds, options.scenes))
        if options.tests:
            found[model] += validation(model, seeds, options.tests)
    rows = []
    for n, (what, target, _) in enumerate(found[MODELS[0]]):
        rows.append((what, target, *(found[model][n][2] for model in MODELS)))
    text = f"Machine: {machine()}. {len(seeds)} seed{'s' if len(seeds) > 1 else ''}: median (min to max).\n\n"
    write_between("models_table", text + table(("", "target", *MODELS), rows))


if __name__ == "__main__":
    main()
