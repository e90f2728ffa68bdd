# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Shared by the scripts that write docs/results.md: the paths of program and models, running, tables, markers."""
import json
import os
import pathlib
import platform
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/throng"
WORLDS = ROOT.parent / "shared/worlds"
WORK = ROOT / "build/results"
# Four default classes, and two that climb.
SIX_CLASSES = [
    {"name": "adult"},
    {"name": "child", "height": 1.1, "radius": 0.18, "step": 0.3},
    {"name": "wheelchair", "height": 1.35, "radius": 0.4, "step": 0.02, "max_slope": 3.4336303624505224},
    {"name": "giant", "height": 3.0, "radius": 0.5, "step": 0.8},
    {"name": "climber", "climb_slope": 120},
    {"name": "gecko", "height": 0.5, "radius": 0.2, "step": 0.25, "climb_slope": 180},
]


def say(text):
    print(text, file=sys.stderr, flush=True)


def run_json(*command):
    """Runs a command that prints one JSON object, and returns it; exits if the command fails."""
    say("$ " + " ".join(str(word) for word in command))
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode not in (0, 1) or not done.stdout.strip():
        sys.exit(f"{command[0]} failed with exit code {done.returncode}")
    return json.loads(done.stdout)


def machine():
    """One line: processor, cores, memory, system, compiler."""
    model = "unknown processor"
    cpuinfo = pathlib.Path("/proc/cpuinfo")
    if cpuinfo.exists():
        names = [line.split(":")[1].strip() for line in cpuinfo.read_text().splitlines()
                 if line.startswith("model name")]
        model = names[0] if names else model
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    return (f"{model}, {len(os.sched_getaffinity(0))} cores, {memory:.0f} GiB, "
            f"{platform.system()} {platform.machine()}, g++ release build")


def table(head, rows):
    """A Markdown table."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines)


def write_between(marker, text, page="docs/results.md"):
    """Replaces the text between <!-- begin marker --> and <!-- end marker -->."""
    path = ROOT / page
    begin, end = f"<!-- begin {marker} -->", f"<!-- end {marker} -->"
    content = path.read_text()
    if begin not in content or end not in content:
        sys.exit(f"{page}: the markers of {marker} are missing; put {begin} and {end} back")
    head, rest = content.split(begin, 1)
    tail = rest.split(end, 1)[1]
    path.write_text(f"{head}{begin}\n{text}\n{end}{tail}")
    say(f"wrote {marker} into {page}")


def rows_between(marker, page="docs/results.md"):
    """The rows of the first table between the markers, without its head, cells as text."""
    content = (ROOT / page).read_text()
    text = content.split(f"<!-- begin {marker} -->", 1)[1].split(f"<!-- end {marker} -->", 1)[0]
    rows = []
    for line in text.splitlines():
        if line.startswith("|"):
            rows.append(tuple(cell.strip() for cell in line.strip("|").split("|")))
        elif rows:
            break
    return rows[2:]


def human(count):
    for unit, size in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count >= size:
            return f"{count / size:.1f} {unit}"
    return f"{count} B"
