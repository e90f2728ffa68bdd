# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Times impostors beside three.js's instanced quads at the same places, in one page of headless Chromium.

Needs Emscripten, Chromium and npm (docs/web.md).

scripts/results web [--rounds N]"""
import argparse
import os
import subprocess
import sys

from results_page import ROOT, machine, run_json, say, table, write_between

MODULES = ROOT / "build/web-deps/npm/node_modules"
BUILD = ROOT / "build/web"
MIN_RATIO = 5


def prepare():
    """Builds the page's code and installs the other library."""
    environment = os.environ | {"NODE_PATH": os.environ.get("NODE_PATH", "/usr/share/nodejs")}
    commands = [["scripts/web"], ["cmake", "-S", ".", "-B", BUILD, "-DTHRONG_BUILD_BENCH=ON"],
                ["cmake", "--build", BUILD, "--target", "throng_web_bench"],
                ["cmake", "-S", ".", "-B", BUILD, "-DTHRONG_BUILD_BENCH=OFF"]]
    missing = [name for name in ("playwright-core", "three") if not (MODULES / name).is_dir()]
    if missing:
        commands.append(["npm", "install", "--prefix", MODULES.parent, "--no-audit", "--no-fund", "--silent", *missing])
    for command in commands:
        say("$ " + " ".join(str(word) for word in command))
        if subprocess.run(command, cwd=ROOT, env=environment, stdout=sys.stderr, check=False).returncode != 0:
            sys.exit("web: the command above failed")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=7)
    rounds = parser.parse_args().rounds
    prepare()
    os.environ["NODE_MODULES"] = str(MODULES)
    report = run_json("node", ROOT / "bench/web/run.mjs", BUILD / "bench", MODULES, rounds)
    rows, met = [], True
    empty = report["empty"]
    for row in report["rows"]:
        ratio = row["still"] / row["ours"]
        met = met and ratio >= MIN_RATIO
        # An empty frame of ours, as a share of the time that a frame may take.
        share = empty["ours"] / (row["still"] / MIN_RATIO)
        rows.append((f"{row['avatars']:,}".replace(",", " "), row["drawn"],
                     f"{row['ours']:.0f} ({row['least']:.0f} to {row['most']:.0f})", f"{row['still']:.0f}", f"{row['moving']:.0f}",
                     f"{ratio:.1f}, target >= {MIN_RATIO}: {'met' if ratio >= MIN_RATIO else 'MISSED'}", f"{row['moving'] / row['ours']:.1f}",
                     f"{share:.0%}"))
    head = ("avatars", "in the picture", "impostors, packed and sent in each frame [ms]", "three.js quads, still [ms]",
            "three.js quads, moving [ms]", "still / impostors", "moving / impostors", f"our empty frame, share of still / {MIN_RATIO}")
    write_between("web_table", "\n".join([
        f"{machine().replace(', g++ release build', '')}; Chromium {report['chromium']}, {report['renderer']}; three.js r{report['three']}. Medians of {rounds} frames. "
        f"An empty frame: {empty['ours']:.1f} ms for ours (its sky), {empty['theirs']:.1f} for three.js (one colour).", "",
        table(head, rows)]))
    return 0 if met else 1


sys.exit(main())
