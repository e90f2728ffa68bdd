# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Records crowds of wanderers and of avatars with goals: bytes and time an avatar and frame.

scripts/results recording [--runs N]"""
import argparse
import os
import statistics
import subprocess

from results_page import PROGRAM, WORK, human, machine, run_json, table, write_between

# Avatars, steps: sparse, dense, so dense that hardly any avatar can move; a large crowd; and with goals.
GOALS = ("--goals", "random", "--near", 50)
CROWDS = [("garage_60", "size=60,levels=4", 500, 1000), ("garage_60", "size=60,levels=4", 2000, 500),
          ("garage_60", "size=60,levels=4", 6000, 300), ("garage_382", "size=382,levels=4", 100000, 100),
          ("garage_60", "size=60,levels=4", 500, 1000, *GOALS), ("garage_60", "size=60,levels=4", 2000, 500, *GOALS)]
LIMIT = 3.0  # An avatar and frame. [bytes]


def cpu_seconds(command):
    """Processor time of the process on all cores: other load counts less than in wall-clock time."""
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        raise SystemExit(f"{command[0]} failed")
    return usage.ru_utime + usage.ru_stime


def row(runs, world, options, avatars, steps, *more):
    folder = WORK / f"{world}.throng"
    if not folder.exists():
        run_json(PROGRAM, "bake", f"builtin:garage,{options}", "-o", folder, "--json")
    file, csv = WORK / "table.replay", WORK / "table.csv"
    plain = [PROGRAM, "run", folder, "--avatars", avatars, "--steps", steps, "--threads", 2, "--check-every", steps,
             *(more or ["--wander"])]
    costs = []
    for _ in range(runs):
        without = cpu_seconds(plain)
        costs.append((cpu_seconds([*plain, "--record", file]) - without) * 1e9 / (avatars * (steps + 1)))
    report = run_json(PROGRAM, "replay", file, "--csv", csv, "--json")
    checked = run_json(PROGRAM, "replay", file, "--check", "--json")
    area = run_json(PROGRAM, "info", folder, "--json")["classes"][0]["walkable_area"]
    size, text = report["bytes"], csv.stat().st_size
    file.unlink()
    csv.unlink()
    same = "yes" if checked["first_difference"] is None else f"NO, step {checked['first_difference']}"
    return (avatars, "goals" if more else "wanderers", f"{area / avatars:.1f}", steps + 1, human(size), report["bytes_per_position"],
            f"{text / size:.0f}", "-" if more else f"{statistics.median(costs):.0f}", same)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", default=5, type=int)
    runs = parser.parse_args().runs
    WORK.mkdir(parents=True, exist_ok=True)
    rows = [row(runs, *crowd) for crowd in CROWDS]
    worst = max(r[5] for r in rows)
    rows = [(*r[:5], f"{r[5]:.2f}", *r[6:]) for r in rows]
    text = f"Machine: {machine()}. Built-in garage, dt 0.1 s, every step a frame; median of {runs} runs for the time; beside the steps of a crowd with goals it is too short to measure.\n\n"
    text += table(["avatars", "crowd", "m2 for each", "frames", "file", "bytes an avatar and frame", "size of CSV / file",
                   "recording, ns of one core an avatar and frame", "replays the same"], rows)
    text += f"\n\nTarget: at most {LIMIT:g} bytes an avatar and frame. Max of these: {worst:.2f}, {'met' if worst <= LIMIT else 'MISSED'}."
    write_between("recording_table", text)


main()
