# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Times crates that block paths in cities of growing size, on the ground and in the air, and fields of distances.

scripts/results live [--sides M...] [--trials N]"""
import argparse
import shutil

from results_page import PROGRAM, ROOT, WORK, human, machine, run_json, table, write_between

BENCH = ROOT / "build/release/bench/bench_live"
AIR_BENCH = ROOT / "build/release/bench/bench_air_changes"
AIR_CELL = 0.5  # [m]
CELL = 0.5  # [m]
MAX_MS = 2.0  # Until paths avoid a crate. [ms]


def times(spread):
    return f"{spread['median']:.3f} / {spread['p99']:.3f} / {spread['max']:.3f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sides", nargs="+", default=[1000, 4000, 10000], type=int)
    parser.add_argument("--air-sides", nargs="+", default=[500, 1000, 2000], type=int)
    parser.add_argument("--trials", default=1000, type=int)
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    crates, fields = [], []
    for side in options.sides:
        folder = WORK / "city.throng"
        run_json(PROGRAM, "bake", f"builtin:city,size={side}", "-o", folder, "--rebuild", "--cell", CELL, "--json")
        report = run_json(BENCH, folder, "--trials", options.trials)
        shutil.rmtree(folder)
        area = f"{side * side / 1e6:g}"
        made = report["crates"]
        verdict = "met" if made["until_avoided_ms"]["median"] < MAX_MS else "MISSED"
        crates.append((area, made["trials"], times(made["first_path_ms"]), times(made["add_ms"]), times(made["path_after_ms"]),
                       f"{times(made['until_avoided_ms'])}: {verdict}", times(made["remove_ms"]),
                       made["paths_through_crates"]))
        field = report["field"]
        fields.append((area, f"{field['most_m']:g}", field["points"], human(field["bytes"]), f"{field['seconds']:.3f}",
                       f"{field['distance_us']:.2f}"))
    air = []
    for side in options.air_sides:
        folder = WORK / "city.throng"
        run_json(PROGRAM, "bake", f"builtin:city,size={side}", "-o", folder, "--rebuild", "--cell", CELL, "--fly", "--air", AIR_CELL, "--json")
        for standing in (0, 1000):
            report = run_json(AIR_BENCH, folder, "--trials", options.trials, "--standing", standing)
            made = report["crates"]
            verdict = "met" if made["until_avoided_ms"]["median"] < MAX_MS else "MISSED"
            air.append((f"{side * side / 1e6:g}", f"{report['boxes'] / 1e6:.1f}", standing, times(made["path_before_ms"]), times(made["add_ms"]),
                        times(made["path_after_ms"]), f"{times(made['until_avoided_ms'])}: {verdict}", times(made["remove_ms"]),
                        made["paths_made_longer"], made["paths_blocked_by_crates"]))
        shutil.rmtree(folder)
    text = (f"Machine: {machine()}. `city`, cells of {CELL} m, adult, one thread. Paths of about 20 m between random places; a crate "
            "of 1 m over the middle of each. Milliseconds, median / 99 % / max.\n\n")
    text += table(["km2", "crates", "the path before, its ground built on first use", "to add", "to find the path around",
                   f"until it avoids the crate, target < {MAX_MS:g}", "to remove", "paths through crates"], crates)
    text += "\n\nFields of distances around one goal:\n\n"
    text += table(["km2", "searched up to, m", "points", "bytes", "seconds", "a distance, us"], fields)
    text += f"\n\nThe same through the air, cells of {AIR_CELL} m, a flyer (`bench_air_changes`); some worlds are full of other crates:\n\n"
    text += table(["km2", "free boxes, million", "other crates", "the path before", "to add", "to find the path around", f"until it avoids the crate, target < {MAX_MS:g}",
                   "to remove", "paths that got longer", "disconnected"], air)
    write_between("live_table", text)


main()
