# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Repeats the experiment of [CAACD] section V: collisions by avatars and parameter set.

Writes its tables into docs/results.md and figures 9, 10 and 11 into docs/images.

scripts/results caacd [--seeds N] [--threads T]"""
import argparse

from results_page import PROGRAM, ROOT, run_json, table, write_between

BAD = ("1.0/1.0/0.06", "1.0/0.8/0.06")
BEST = "2.0/0.4/0.06"
NAMED = (*BAD, BEST)
COUNTS = list(range(5, 101, 5))
STEPS = [10, 30, 40, 50, 100]  # Where the paper gives a number.
IMAGES = ROOT / "docs/images"
# One at a time, from 1.0/0.4/0.06: the sets of a sweep that holds the three named ones, if mass, speed and force are
# varied in turn, as "depending on the parameter being tested" suggests.
SWEEP = ["1.0/0.4/0.06", "1.5/0.4/0.06", "2.0/0.4/0.06", "1.0/0.6/0.06", "1.0/0.8/0.06", "1.0/1.0/0.06", "1.0/1.2/0.06",
         "1.0/0.4/0.02", "1.0/0.4/0.10", "1.0/0.4/0.20"]
READINGS = [("alert field (ours)", ()), ("every threat", ("--trigger", "threat")), ("probes meet", ("--trigger", "zones")),
            ("probes meet, of 10 + 20 frames", ("--trigger", "zones", "--fields", "5,10,20", "--zone-time", "20")),
            ("no avoidance", ("--trigger", "never")), ("eq. 10 as printed", ("--length", "max-sum"))]
SETTINGS = [("ours", ()),
            ("T3 = 20", ("--t3", 20)), ("T3 = 40", ("--t3", 40)), ("T3 = 120", ("--t3", 120)),
            ("lambda3 = 0", ("--lambda3", 0)), ("lambda3 = 1", ("--lambda3", 1)),
            ("psi = 10", ("--psi", 10)), ("psi = 60", ("--psi", 60)),
            ("alert 8", ("--fields", "5,7.5,8")), ("alert 10", ("--fields", "5,7.5,10")), ("alert 20", ("--fields", "5,7.5,20")),
            ("all fields x 0.8", ("--fields", "4,6,9.6")), ("all fields x 1.2", ("--fields", "6,9,14.4")),
            ("side 350", ("--side", 350)), ("side 500", ("--side", 500)), ("no obstacles", ("--obstacles", 0)),
            ("half frames", ("--dt", 0.5))]


class Study:
    def __init__(self, options, *words, sets=(), counts=COUNTS):
        listed = [word for name in sets for word in ("--set", name)]
        self.report = run_json(PROGRAM, "caacd", "--json", "--seeds", options.seeds, "--threads", options.threads, "--avatars",
                               ",".join(map(str, counts)), *listed, *words)
        self.sets = {row["set"]: row for row in self.report["sets"]}
        self.counts = counts

    def at(self, name, avatars, what="mean"):
        return self.sets[name][what][self.counts.index(avatars)]

    def total(self, name):
        return sum(self.sets[name]["mean"])

    def cell(self, name, avatars):
        return f"{self.at(name, avatars):.1f} +- {self.at(name, avatars, 'deviation'):.1f} ({self.at(name, avatars, 'max')})"

    def reported(self, which, avatars):
        return self.report["reported"][which][self.counts.index(avatars)]


def named_table(study):
    rows = [(n, *(study.cell(name, n) for name in NAMED), f"<= {study.reported('bad', n)}", f"<= {study.reported('others', n)}")
            for n in COUNTS]
    return table(["avatars", *NAMED, "[CAACD], the two bad sets", "[CAACD], all others"], rows)


def steps_table(study):
    """Whether the paper's number bounds the mean, and every run."""
    def verdict(names, which, n):
        mean = max(study.at(name, n) for name in names)
        largest = max(study.at(name, n, "max") for name in names)
        bound = study.reported(which, n)
        return f"{mean:.1f} ({largest}): " + ("every run" if largest <= bound else "the mean" if mean <= bound else "NOT")
    sweep = [name for name in SWEEP if name not in BAD]
    rows = [(n, f"<= {study.reported('bad', n)}", verdict(BAD, "bad", n), f"<= {study.reported('others', n)}",
             verdict([BEST], "others", n), verdict(sweep, "others", n)) for n in STEPS]
    return table(["avatars", "[CAACD], bad sets", "here, the worse of the two", "[CAACD], others", f"here, {BEST}",
                  "here, the worst other of the sweep"], rows)


def order_table(study):
    order = sorted(SWEEP, key=study.total)
    rows = [(name, f"{study.total(name):.1f}", *(f"{study.at(name, n):.1f}" for n in STEPS),
             f"{sum(study.sets[name]['obstacles']):.1f}", f"{study.total(name) + sum(study.sets[name]['obstacles']):.1f}")
            for name in order]
    return table(["set", "sum of means, 5 to 100", *(f"{n} avatars" for n in STEPS), "sum with obstacles alone", "both"], rows)


def grid_table(study, avatars):
    masses, speeds, forces = ("1.0", "1.5", "2.0"), ("0.4", "0.6", "0.8", "1.0", "1.2"), ("0.02", "0.06", "0.10", "0.20")
    rows = [(m, f, f"{float(f) / float(m):.3f}", *(f"{study.at(f'{m}/{v}/{f}', avatars):.1f}" for v in speeds))
            for m, f in sorted(((m, f) for m in masses for f in forces), key=lambda p: float(p[1]) / float(p[0]))]
    return table(["Mass", "MaxForce", "Force / Mass", *(f"MaxSpeed {v}" for v in speeds)], rows)


def settings_table(options, settings, others=()):
    rows = []
    for name, words in settings:
        study = Study(options, *words, sets=(*NAMED, *others), counts=[10, 50, 100])
        values = [study.at(set_name, 100) for set_name in NAMED]
        cells = [f"{study.at(s, 10):.1f} / {study.at(s, 50):.1f} / {study.at(s, 100):.1f}" for s in (*NAMED, *others)]
        rows.append((name, *cells, "yes" if min(values[:2]) > values[2] else "NO", f"{values[0] / max(values[2], 0.1):.1f}"))
    return table(["", *NAMED, *others, "bad sets are worse", "first / third at 100"], rows)


def claims(study, grid):
    total = study.total
    sweep = sorted(SWEEP, key=total)
    worse = [name for name in grid.sets if name not in BAD and grid.total(name) >= min(grid.total(b) for b in BAD)]
    better = [name for name in grid.sets if grid.total(name) < grid.total(BEST)]

    def braking(name):
        mass, speed, force = map(float, name.split("/"))
        return speed ** 2 * mass / force  # Radius of the tightest turn.
    agile = [name for name in worse if braking(name) < min(braking(b) for b in BAD)]
    fast = [name for name in better if float(name.split("/")[1]) > 0.4]
    rows = [("of the three named sets, the two bad ones are worst and 2.0/0.4/0.06 is best",
             "yes" if total(BAD[0]) > total(BAD[1]) > total(BEST) else "NO: " + ", ".join(f"{n} {total(n):.0f}" for n in NAMED)),
            ("of the sweep (one parameter at a time), the two are the worst",
             f"{sweep.index(BAD[0]) + 1} and {sweep.index(BAD[1]) + 1} of {len(sweep)} from the best; last is {sweep[-1]}"),
            ("of the sweep, 2.0/0.4/0.06 is best",
             f"{sweep.index(BEST) + 1} of {len(sweep)}: {total(BEST):.1f} against {total(sweep[0]):.1f} of {sweep[0]}"),
            ("of the grid of 60, the two are the worst",
             f"{len(worse)} others are as bad; {len(agile)} of them can turn more tightly than 1.0/0.8/0.06"),
            ("of the grid of 60, 2.0/0.4/0.06 is best", f"{len(better)} are better; {len(fast)} of them are faster than 0.4"),
            ("figure 10 has the two bad sets above all others at 100 avatars",
             f"the mean of {len(grid.sets)} sets is {ranks(grid, 100)[0]:.0f}, the two bad ones have "
             f"{grid.at(BAD[0], 100):.0f} and {grid.at(BAD[1], 100):.0f}"),
            ("the number grows slowly to 50 avatars and steeply to 100",
             "; ".join(f"{name}: x {study.at(name, 100) / study.at(name, 50):.1f} from 50 to 100" for name in NAMED)
             + "; [CAACD] x 9.9 and 3.3")]
    return table(["claim", "here"], rows)


def priorities_table(study, by_state):
    """The printed order of threats, and states first."""
    rows = [(n, *(f"{study.cell(name, n)} / {by_state.cell(name, n)}" for name in NAMED)) for n in COUNTS]
    rows.append(("sum of means", *(f"{study.total(name):.1f} / {by_state.total(name):.1f}" for name in NAMED)))
    return table(["avatars", *NAMED], rows)


def ranks(study, avatars):
    """Places of the named sets among all of a study, from the worst, and the mean of all."""
    worst_first = sorted(study.sets, key=lambda name: -study.at(name, avatars))
    mean = sum(study.at(name, avatars) for name in study.sets) / len(study.sets)
    return mean, [(study.at(name, avatars), worst_first.index(name) + 1) for name in NAMED]


def search_table(options):
    """Figure 10 puts the two bad sets above all others: does any choice of what the paper leaves open?"""
    options = argparse.Namespace(seeds=min(options.seeds, 5), threads=options.threads)
    rows, found = [], 0
    for name, words in READINGS + SETTINGS[1:]:
        study = Study(options, "--grid", *words, counts=[100])
        mean, places = ranks(study, 100)
        as_printed = places[0][1] <= 2 and places[1][1] <= 2
        found += as_printed
        rows.append((name, f"{mean:.1f}", *(f"{value:.1f}, {place}." for value, place in places), "yes" if as_printed else "no"))
    return found, table(["", f"mean of {len(study.sets)} sets", *NAMED, "the two bad sets are the worst"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", default=30, type=int)
    parser.add_argument("--threads", default=2, type=int)
    options = parser.parse_args()
    IMAGES.mkdir(parents=True, exist_ok=True)
    study = Study(options, "--figure10", IMAGES / "caacd_figure10.png", "--figure11", IMAGES / "caacd_figure11.png", sets=SWEEP)
    by_state = Study(options, "--order", "state", sets=NAMED)
    grid = Study(options, "--grid", counts=STEPS)
    found, search = search_table(options)
    run_json(PROGRAM, "caacd", "--json", "--set", BEST, "--avatars", 40, "--at", 250, "--figure9", IMAGES / "caacd_figure9.png")
    text = [f"{options.seeds} seeds; mean +- standard deviation (max) of collisions a run. State {study.report['state_hash']}.",
            named_table(study),
            "The paper's steps: the mean and (the maximum of all runs), and which of them is within the paper's number.", steps_table(study),
            "Claims.", claims(study, grid),
            "One parameter at a time, in ascending order of collisions.", order_table(study),
            "The grid over the paper's ranges: means with 100 avatars.", grid_table(grid, 100),
            "Readings: means with 10 / 50 / 100 avatars.", settings_table(options, READINGS, ("1.0/0.4/0.20",)),
            "Priorities of the states, the paper's future work (`--order state`): collisions a run, in the printed order of threats / by state.",
            priorities_table(study, by_state),
            f"Figure 10's order, over what the paper leaves open (radii, space, time step, readings): with 100 avatars, means over "
            f"{min(options.seeds, 5)} seeds and places from the worst. {found} of {len(READINGS) + len(SETTINGS) - 1} choices give it.", search,
            "What the paper does not print: the same, one setting changed.", settings_table(options, SETTINGS)]
    write_between("caacd_table", "\n\n".join(text))


main()
