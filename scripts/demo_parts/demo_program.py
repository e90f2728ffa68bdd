# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""What the scripts of the demo share: they call the program and show the commands as typed."""
import json
import pathlib
import shlex
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/throng"


class Failed(Exception):
    """Carries the program's error message."""


def shown(program, words):
    """The command as typed, once demo_out.part is renamed to demo_out."""
    return f"{program} " + shlex.join(words).replace("demo_out.part/", "demo_out/")


def call(*arguments, allowed=(0,)):
    """Calls the program. Returns its report, the command as shown, its exit code and its notes; raises Failed."""
    words = [str(word) for word in arguments]
    print(f"  throng {' '.join(words)}", flush=True)
    try:
        done = subprocess.run([PROGRAM, *words, "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              check=False)
    except OSError as error:
        raise Failed(str(error)) from error
    notes = [line for line in done.stderr.splitlines() if "note:" in line]
    if done.returncode not in allowed:
        said = [line for line in done.stderr.splitlines() if line.startswith("throng:") and line not in notes]
        raise Failed(" ".join(line.removeprefix("throng: ") for line in said) or done.stderr.strip()[-300:]
                     or f"exit code {done.returncode}")
    return json.loads(done.stdout), shown("throng", words), done.returncode, notes


def keep_last_step(csv):
    """Keeps only the last step of a trajectory file, the one that a picture shows."""
    lines = csv.read_text().splitlines()
    last = lines[-1].split(",")[0] + ","
    csv.write_text("\n".join([lines[0]] + [line for line in lines[1:] if line.startswith(last)]) + "\n")
