# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Walks crowds through all scenes until 10^9 avatar-steps have been checked.

scripts/results many_steps [--minutes M] [--fresh]

Continues where the last call stopped: the counts are in build/results/many_steps.json."""
import argparse
import json
import sys
import time

from results_page import ROOT, WORK, WORLDS, run_json, say, table, write_between

SCENES = ROOT / "build/release/bench/bench_scenes"
CROWD = ROOT / "build/release/bench/bench_crowd"
TARGET = 10**9


def scenes():
    """Name, and the command for a seed: each takes some minutes at most."""
    def play(*words):
        return lambda seed: (SCENES, *words, "--seed", seed)

    yield "corridor", play("corridor", "--bodies", 2000, "--area", 4, "--seconds", 800)
    yield "crossing", play("crossing", "--bodies", 1000, "--area", 4, "--seconds", 300)
    yield "crossing, dense", play("crossing", "--bodies", 1000, "--area", 2, "--seconds", 200)
    for world in ("garage", "church", "bridge", "maze", "stairs"):
        yield world, play(world, "--bodies", 400, "--seconds", 100)
    yield "city", play("city", "--bodies", 5000, "--seconds", 30)
    for case in sorted((WORLDS / "steersuite").glob("*.xml")):
        yield case.stem, play(case, "--seconds", 200)
    for name, area in (("random scene", 4), ("random scene, dense", 1)):
        yield name, lambda seed, area=area: (CROWD, "--avatars", 1_000_000, "--area", area, "--warm", 0, "--steps", 25, "--check-every", 1,
                                             "--seed", seed)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=8, help="stop after the run in which this time is over")
    parser.add_argument("--fresh", action="store_true", help="forget the counts")
    options = parser.parse_args()
    state = WORK / "many_steps.json"
    counted = {} if options.fresh or not state.exists() else json.loads(state.read_text())
    WORK.mkdir(parents=True, exist_ok=True)
    start = time.monotonic()
    checked = lambda: sum(c["checked"] for c in counted.values())
    plays = list(scenes())
    while checked() < TARGET and time.monotonic() - start < 60 * options.minutes:
        # Each scene once, then those of a million.
        name, command = min(plays, key=lambda p: (counted.get(p[0], {}).get("runs", 0) if p[0].startswith("random") else
                                                  (-1 if p[0] not in counted else 10**6)))
        here = counted.setdefault(name, {"runs": 0, "steps": 0, "checked": 0, "overlaps": 0, "wall_entries": 0})
        found = run_json(*command(here["runs"] + 1))
        if "error" in found:
            sys.exit(f"{name}: {found['error']}")
        here["runs"] += 1
        here["steps"] += found["avatar_steps"]
        here["checked"] += found["checked_avatar_steps"]
        here["overlaps"] += found["overlaps"]
        here["wall_entries"] += found["wall_entries"]
        state.write_text(json.dumps(counted, indent=1))
    rows = [(name, c["runs"], f"{c['steps']:,}", f"{c['checked']:,}", c["overlaps"], c["wall_entries"]) for name, c in counted.items()]
    sums = [sum(c[key] for c in counted.values()) for key in ("runs", "steps", "checked", "overlaps", "wall_entries")]
    rows.append(("all", sums[0], f"{sums[1]:,}", f"{sums[2]:,}", sums[3], sums[4]))
    met = sums[2] >= TARGET and sums[3] + sums[4] == 0
    write_between("many_steps_table", table(("scene", "runs", "avatar-steps", "of these checked", "overlaps", "walls entered"), rows) +
                  f"\n\nTarget: 10^9 avatar-steps checked, 0 faults: {'met' if met else 'MISSED'}.")
    say("done" if met else "call it again to continue")


if __name__ == "__main__":
    sys.exit(main())
