# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Runs `throng validate`, several seeds each: tables and charts of realism.

Without names: all tests that are not in work, and those of recordings in ../shared/worlds/pedestrians where that folder exists. A test passes if
it passes with all seeds; a number is given from its minimum to its maximum. Charts are those of the first seed.

scripts/results validate [TEST...] [--threads T] [--seeds N]"""
import argparse
import math

from results_page import PROGRAM, ROOT, WORLDS, machine, run_json, table, write_between

IMAGES = ROOT / "docs/images"


def target(measure):
    low, high = measure.get("low", -math.inf), measure.get("high", math.inf)
    if low == -math.inf and high == math.inf:
        return ""
    if low == high:
        return f"{low:.4g}"
    if low == -math.inf:
        return f"<= {high:.4g}"
    return f">= {low:.4g}" if high == math.inf else f"{low:.4g} to {high:.4g}"


def short(number):
    if number is None:
        return "none"
    return f"{number:g}" if number == int(number) else f"{number:.3g}" if abs(number) < 100 else f"{number:.1f}"


def value(measure):
    """The values of all seeds, from min to max."""
    numbers = sorted({v for v in measure["values"] if v is not None})
    texts = [short(v) for v in ([numbers[0], numbers[-1]] if numbers else [])]
    text = " to ".join(dict.fromkeys(texts))
    if None in measure["values"]:
        text = f"{text} or none" if text else "none"
    return f"{text} {measure['unit']}".rstrip()


def missed(measure):
    return measure.get("misses", 0) > 0


def verdict(test):
    if "lacks" in test:
        return "not modelled"
    if all("passed" not in m for m in test["measures"]):
        return "reported"
    if test["passes"] == test["runs"]:
        return "passed"
    return "MISSED" if test["passes"] == 0 else f"MISSED with {test['runs'] - test['passes']} of {test['runs']} seeds"


def faults(test):
    return test["overlaps"] + test["wall_entries"] + test["obstacle_entries"]


def merged(runs):
    """The same test with several seeds, as one."""
    test = dict(runs[0])
    if "lacks" in test:
        return test
    test["runs"], test["passes"] = len(runs), sum(r["passed"] for r in runs)
    for key in ("overlaps", "wall_entries", "obstacle_entries", "checks", "simulated", "seconds"):
        test[key] = sum(r[key] for r in runs)
    for n, m in enumerate(test["measures"]):
        same = [r["measures"][n] for r in runs]
        m["values"] = [s["value"] for s in same]
        m["misses"] = sum(s.get("passed") is False for s in same)
    return test


def standard_row(test):
    """A test of a standard as a row: what was measured, and the target in brackets."""
    if "lacks" in test:
        return (test["test"], test["title"], test["lacks"], "not modelled")
    cells = []
    for m in test["measures"]:
        cells.append(f"{m['name']}: {value(m)}" + (f" ({target(m)}{', MISSED' if missed(m) else ''})" if target(m) else ""))
    return (test["test"], test["title"], "; ".join(cells), verdict(test))


def standards(name, tests):
    count = {kind: sum(verdict(t).startswith(kind) for t in tests) for kind in ("passed", "MISSED", "reported", "not modelled")}
    checks, entered = sum(t.get("checks", 0) for t in tests), sum(faults(t) for t in tests if "checks" in t)
    return "\n".join([f"### {name}", "",
                      f"{count['passed']} passed, {count['MISSED']} missed, {count['reported']} only reported, {count['not modelled']} not modelled. "
                      f"Overlaps and walls entered: {entered} in {checks} checks.", "",
                      table(["test", "", "measured (target)", ""], map(standard_row, tests))])


def by_scene(test):
    """Names are "scene: what": a column for each scene."""
    scenes, rows = [], {}
    for m in test["measures"]:
        scene, what = m["name"].split(": ", 1)
        if scene not in scenes:
            scenes.append(scene)
        rows.setdefault(what, {})[scene] = value(m)
    return table(["", *scenes], [(what, *(row.get(s, "") for s in scenes)) for what, row in rows.items()])


def measures(test):
    return table(["measure", "here", "target", ""],
                 [(m["name"], value(m), target(m), "" if "passed" not in m else "MISSED" if missed(m) else "met") for m in test["measures"]])


def section(test):
    recorded = test["test"] in ("walkers", "laboratory")
    lines = [f"### {test['test']}: {test['title']}", "", f"{test['method']} Range: {test['source']}.", "",
             by_scene(test) if recorded else measures(test), "",
             f"{faults(test)} overlaps and walls entered in {test['checks']} checks; {test['simulated']:.0f} s simulated in {test['seconds']:.0f} s. "
             f"**{verdict(test)[0].upper()}{verdict(test)[1:]}.**"]
    for chart in test["charts"]:
        lines += ["", f"![{chart}](images/validate_{chart}.png)"]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tests", nargs="*")
    parser.add_argument("--threads", default=0, type=int)
    parser.add_argument("--seeds", default=3, type=int)
    options = parser.parse_args()
    out = ROOT / "build/results/validate"
    out.mkdir(parents=True, exist_ok=True)
    people, runs = WORLDS / "pedestrians", []
    for seed in range(options.seeds, 0, -1):  # The first seed runs last, so that its charts stay.
        common = ("--json", "-o", out, "--threads", options.threads, "--seed", seed)
        found = run_json(PROGRAM, "validate", *options.tests, *common)["tests"]
        if not options.tests and people.is_dir():
            found += run_json(PROGRAM, "validate", "walkers", people, "laboratory", people / "juelich", *common)["tests"]
        runs.insert(0, found)
    found = [merged(list(same)) for same in zip(*runs)]
    IMAGES.mkdir(parents=True, exist_ok=True)
    for test in found:
        for chart in test.get("charts", []):
            (IMAGES / f"validate_{chart}.png").write_bytes((out / f"{chart}.png").read_bytes())
    text = [f"Machine: {machine()}. {options.seeds} seeds: a test passes if it passes with all; numbers are given from min to max."]
    for name, key in (("RiMEA", "rimea."), ("NIST TN 1822", "nist.")):
        tests = [t for t in found if t["test"].startswith(key)]
        if tests:
            text.append(standards(name, sorted(tests, key=lambda t: [int(n) for n in t["test"].split(".")[1:]])))
    text += [section(t) for t in found if not t["test"].startswith(("rimea.", "nist."))]
    write_between("validate_table", "\n\n".join(text))


main()
