# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bakes and verifies every built-in world and every model in ../shared/worlds.

The default of 10 000 000 samples takes a minute or two on two cores.

scripts/results verify [SAMPLES] [--coarse] [--only TEXT] [--threads T] [--print]

SAMPLES are distributed evenly over the worlds, their classes, and states, moves and points of surfaces.
Exit code 1 if any world fails to bake or to pass; those whose losses are known may lose so much and no more."""
import argparse
import json
import shutil
import subprocess
import sys

from all_worlds import worlds
from results_page import PROGRAM, WORK, machine, say, table, write_between

CLASSES = 4  # The default ones.
FEET_MEAN, FEET_P95 = 0.010, 0.030  # Limits of feet_error at 0.1 m cells. [m]
MAX_LOST = 0.01  # Of the places of a body that is grown by a cell and a resolution.
KNOWN_LOSSES = {  # Missed, as the table says. Beyond these a class has got worse.
    ("cities/rotterdam_subset.city.json", "child"): 0.012,
    ("bezier/teapot.bpt", "child"): 0.17,
    ("bezier/teapot.bpt", "giant"): 0.06,
}
SURE, CLOSER = 3, 4  # Errors beyond the limit that make a miss certain; else CLOSER times the samples are taken.


class Failed(Exception):
    """Carries the program's error message."""


def run(*words):
    words = [str(word) for word in words]
    say("$ throng " + " ".join(words))
    done = subprocess.run([PROGRAM, *words, "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          check=False)
    if done.returncode not in (0, 1) or not done.stdout.strip():
        lines = [line for line in done.stderr.splitlines() if line.startswith("throng: ") and "note:" not in line]
        raise Failed(lines[-1][len("throng: "):] if lines else f"exit code {done.returncode}")
    return json.loads(done.stdout)


def sample_more(report, words, samples):
    """The loss of a class is known within an error: where that leaves the verdict open, takes more samples."""
    for at, entry in enumerate(report["classes"]):
        lost = entry["lost"]
        if not MAX_LOST < lost["grown"] < MAX_LOST + SURE * lost["grown_error"]:
            continue
        closer = run(*words, "--class", entry["class"], "--samples", CLOSER * samples)
        entry = report["classes"][at] = closer["classes"][0]
        for count in ("states", "moves", "surface_points", "entered", "unsupported", "broken"):
            report[count] += closer[count]
        report["seconds"] += closer["seconds"]
        say(f"  {entry['class']}: with {CLOSER} times the samples lost {entry['lost']['grown'] * 100:.2f} +- {entry['lost']['grown_error'] * 100:.2f} %")
    for part in ("grown", "exact"):
        report["lost"][part] = max(entry["lost"][part] for entry in report["classes"])


def verify(name, model, options, samples, threads, coarse):
    """One row of the table, a note for each class that fails, the number of tests, and is that as good as known?"""
    folder = WORK / "verify.throng"
    try:
        bake = run("bake", model, *options, "-o", folder, "--rebuild", *coarse, "--cell", 0.1, "--resolution", 0.1, "--threads", threads)
        report = run("verify", folder, "--source", model, *options, "--samples", samples, "--threads", threads)
        sample_more(report, ["verify", folder, "--source", model, *options, "--threads", threads], samples)
    except Failed as failure:
        return (name, "-", "-", "-", "-", "-", "-", "-", "-", "-", "-", "FAILED"), [f"{name}: {failure}"], 0, False
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    missed = [entry for entry in report["classes"] if not entry["passed"] or not feet_are_right(entry)]
    notes = [note(name, entry) for entry in missed]
    good = all(is_known(name, entry) for entry in missed)
    for entry in report["classes"]:
        for fault in entry["faults"]:
            say(f"  {entry['class']}: {fault['what']} at {fault['feet']}")
    tests = report["states"] + report["moves"] + report["surface_points"]
    feet = report["feet_error"]
    row = (name, report["triangles"], f"{bake['walkable_area'].get('adult', 0):.0f}", tests, report["entered"],
           report["unsupported"], report["broken"], f"{feet['mean'] * 1e3:.1f} / {feet['p95'] * 1e3:.1f}",
           f"{report['lost']['grown'] * 100:.2f}", f"{report['lost']['exact'] * 100:.1f}",
           f"{bake['seconds_total']:.1f} + {report['seconds']:.0f}", "NO" if notes else "yes")
    return row, notes, tests, good


def is_known(name, entry):
    faults = entry["entered"] + entry["unsupported"] + entry["broken"]
    return faults == 0 and feet_are_right(entry) and entry["lost"]["grown"] <= KNOWN_LOSSES.get((name, entry["class"]), 0)


def feet_are_right(entry):
    return entry["feet_error"]["mean"] <= FEET_MEAN and entry["feet_error"]["p95"] <= FEET_P95


def note(name, entry):
    lost, feet = entry["lost"], entry["feet_error"]
    return (f"{name}, {entry['class']}: entered {entry['entered']}, unsupported {entry['unsupported']}, "
            f"broken {entry['broken']}, feet off by {feet['mean'] * 1e3:.1f} / {feet['p95'] * 1e3:.1f} mm, lost {lost['grown'] * 100:.2f} +- {lost['grown_error'] * 100:.2f} % of "
            f"{entry['standable_area']['grown']:.0f} m2")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("samples", nargs="?", default=10_000_000, type=int)
    parser.add_argument("--only", default="", help="worlds whose name has this text; prints, writes nothing")
    parser.add_argument("--threads", default=0, type=int)
    parser.add_argument("--coarse", action="store_true", help="bake with --coarse; prints, writes nothing")
    parser.add_argument("--print", action="store_true", help="print the table, write nothing")
    options = parser.parse_args()

    everything = list(worlds())
    chosen = [world for world in everything if options.only in world[0]]
    if not chosen:
        sys.exit(f"verify: no world's name has '{options.only}' in it")
    samples = max(1, options.samples // (3 * CLASSES * len(everything)))
    rows, notes, tests, good = [], [], 0, True
    for name, model, arguments in chosen:
        row, missed, count, is_good = verify(name, model, arguments, samples, options.threads, ["--coarse"] if options.coarse else [])
        rows.append(row)
        notes += missed
        tests += count
        good = good and is_good

    text = (f"`scripts/results verify {options.samples}{' --coarse' if options.coarse else ''}`. Machine: {machine()}. {tests} tests of {len(chosen)} worlds, "
            f"cells of 0.1 m, four classes: {sum(row[-1] == 'yes' for row in rows)} pass.\n"
            "Errors and losses are those of the worst class; counts are sums.\n\n")
    text += table(["world", "triangles", "m2 adult", "tests", "entered", "unsupported", "broken",
                   "feet mean / p95 [mm]", "lost [%]", "lost exact [%]", "bake + verify [s]", "passes"], rows)
    if notes:
        text += "\n\nMissed:\n\n" + "\n".join(f"- {line}" for line in notes)
    if options.only or options.print or options.coarse:
        print(text)
    else:
        write_between("verify_table", text)
    return 0 if good else 1


sys.exit(main())
