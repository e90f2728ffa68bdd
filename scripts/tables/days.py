# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Runs a station for three simulated days and checks for drift, leaks and avatars without progress.

Takes hours.

scripts/results days [--days N] [--threads T]"""
import argparse
import csv
import statistics
import sys

from results_page import PROGRAM, WORK, human, machine, run_json, table, write_between

DAY, NIGHT = 86400, 4 * 3600  # [s] No avatar enters from midnight on; by four all must have left.
# Hour of the day, avatars that enter a second from then on.
HOURS = [(0, 0), (5, 0.1), (7, 1.0), (9, 0.4), (12, 0.6), (14, 0.4), (16, 1.0), (19, 0.3), (23.5, 0)]
STATION = """seconds = {seconds}
[plane]
floor = [[0, 0], [44, 0], [44, 20], [0, 20]]
obstacles = [
  [[10, 0], [10.2, 0], [10.2, 8], [10, 8]],
  [[10, 12], [10.2, 12], [10.2, 20], [10, 20]],
  [[30, 0], [30.2, 0], [30.2, 20], [30, 20]],
  [[18, 4], [19, 4], [19, 5], [18, 5]],
  [[24, 14], [25, 14], [25, 15], [24, 15]],
]
{areas}
[[profile]]
name = "adult"
speed = {{ normal = [1.34, 0.26], within = [0.7, 2] }}
[[profile]]
name = "child"
class = "child"
speed = {{ uniform = [0.8, 1.2] }}
[[queue]]
name = "tickets"
line = [[13, 0, 17], [26, 0, 17]]
servers = 6
service = {{ exponential = 6 }}
[[link]]
name = "lift"
from = "below"
to = "above"
seconds = 12
interval = 20
capacity = 20
[[link]]
name = "lift down"
from = "above"
to = "below"
seconds = 12
interval = 20
capacity = 20
[[journey]]
name = "travel"
stages = [{{ queue = "tickets" }}, {{ spot = "hall" }}, {{ wait = {{ uniform = [2, 30] }} }}, {{ link = "lift" }}, {{ leave = "train" }}]
[[journey]]
name = "arrive"
stages = [{{ link = "lift down" }}, {{ leave = ["street"] }}]
[[journey]]
name = "pass"
stages = [{{ go = "hall" }}, {{ leave = ["north", "south"], by = "quickest" }}]
[[source]]
name = "town"
area = "street"
profile = {{ adult = 4, child = 1 }}
journey = {{ travel = 2, pass = 1 }}
rates = {rates}
group = {{ uniform = [1, 3] }}
[[source]]
name = "trains"
area = "platform"
profile = "adult"
journey = "arrive"
rates = {rates}
{doors}"""
AREAS = {"street": (0.5, 1, 4, 19), "hall": (12, 2, 26, 12), "below": (27, 8, 29.5, 12), "above": (31, 8, 34, 12), "train": (42, 1, 44, 19),
         "platform": (36, 2, 41, 18), "north": (27, 0, 30, 1), "south": (27, 19, 30, 20)}


def station(days):
    rates = [[day * DAY + hour * 3600, rate / 2] for day in range(days) for hour, rate in HOURS]
    areas = "\n".join(f'[[area]]\nname = "{name}"\nbox = [{", ".join(map(str, box))}]' for name, box in AREAS.items())
    # One of the doors between street and hall is half closed for an hour, at noon.
    doors = "\n".join(f'[[obstacle]]\nname = "works {day + 1}"\nbox = [9, 10.5, 11, 12]\nbegin = {day * DAY + 43200}\nend = {day * DAY + 46800}'
                      for day in range(days))
    file = WORK / "days.toml"
    WORK.mkdir(parents=True, exist_ok=True)
    file.write_text(STATION.format(seconds=days * DAY + NIGHT, areas=areas, rates=rates, doors=doors))
    return file


def run(days, threads):
    visits = WORK / "days.csv"
    report = run_json(PROGRAM, "run", station(days), "--threads", threads, "--check-every", 600, "--trips", visits, "--json")
    with open(visits, newline="", encoding="utf-8") as lines:
        people = [(float(v["entered"]), float(v["left"] or -1)) for v in csv.DictReader(lines)]
    visits.unlink()
    return report, people


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--days", type=int, default=3)
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    first, _ = run(1, options.threads)
    report, people = run(options.days, options.threads)
    rows, stays = [], []
    for day in range(options.days):
        here = [(entered, left) for entered, left in people if day * DAY <= entered < (day + 1) * DAY]
        stay = [left - entered for entered, left in here if left >= 0]
        left_behind = sum(1 for _, left in here if left < 0 or left > (day + 1) * DAY + NIGHT)
        stays.append(statistics.mean(stay))
        rows.append((day + 1, len(here), f"{stays[-1]:.1f}", f"{statistics.median(stay):.1f}", f"{max(stay):.0f}", left_behind))
    left_behind = sum(row[-1] for row in rows)
    drift = max(stays) / min(stays) - 1
    faults = report["wall_entries"] + report["overlaps"] + report["obstacle_entries"]
    grown = report["peak_bytes"] - first["peak_bytes"]
    met = left_behind == 0 and faults == 0 and drift < 0.05 and report["still_here"] == 0
    head = ("day", "entered", "stayed, mean [s]", "median [s]", "longest [s]", "not yet left at four in the morning")
    text = f"Machine: {machine()}.\n\n" + table(head, rows)
    text += (f"\n\n{report['steps']:,} steps of {report['dt']} s, {report['checks']:,} checks of all avatars: {report['overlaps']} overlaps, {report['wall_entries']} walls entered, "
             f"{report['obstacle_entries']} in obstacles. Mean stays differ by {drift * 100:.1f} % (target: less than 5). Memory at the peak: {human(first['peak_bytes'])} after a day, "
             f"{human(report['peak_bytes'])} after {options.days}: {grown / max(1, len(people) - rows[0][1]):.0f} more bytes for each visit, kept until the end. "
             f"No avatar left behind, no faults, no drift: {'met' if met else 'MISSED'}.")
    write_between("days_table", text)
    return 0 if met else 1


sys.exit(main())
