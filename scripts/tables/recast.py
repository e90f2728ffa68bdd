# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Bakes four worlds with Recast and with throng and compares times, floors and bytes.

scripts/results recast [--runs N] [--processes N]"""
import argparse
import statistics
import sys

from results_page import ROOT, WORK, WORLDS, machine, run_json, say, table, write_between

BENCH = ROOT / "build/release/bench/bench_recast"
# World, how Recast is tiled. city400 as one heightfield is slower and larger for Recast.
SPEED = [("nav_test", "none"), ("dungeon", "none"), ("undulating", "none"), ("city400", "best")]
# With --one-sided, where that changes the world.
ONE_SIDED = [("dungeon", "none", "--one-sided")]
SETTINGS = [(0.1, 0.1, 6, 11), (0.3, 0.2, 4, 7)]


def spread(times):
    return f"{times['median']:.1f} ({times['min']:.1f} to {times['max']:.1f})"


def ratio(times):
    return f"{times['median']:.1f} ({times['min']:.1f} to {times['max']:.1f})"


def verdict(times, target):
    return f"{ratio(times)}, target >= {target}: {'met' if times['median'] >= target else 'MISSED'}"


def together(speeds):
    """Of several processes one after the other: the median of their medians, min and max of all."""
    whole = dict(speeds[0])
    for name, times in whole.items():
        if isinstance(times, dict):
            whole[name] = {"median": statistics.median(s[name]["median"] for s in speeds),
                           "min": min(s[name]["min"] for s in speeds), "max": max(s[name]["max"] for s in speeds)}
    return whole


def speed_rows(runs, processes):
    cases = [(setting, case) for setting in SETTINGS for case in [*SPEED, *ONE_SIDED]]
    # A core that was idle is slow at first, whatever runs on it: so each case runs at several times.
    reports = [[run_json(BENCH, WORLDS / f"recast/{world}.obj", "--cell", cell, "--cell-height", height, "--runs", runs,
                      "--tiling", tiling, *sides, "--json")["speed"]
             for (cell, height, _, _), (world, tiling, *sides) in cases] for _ in range(processes)]
    for at, ((cell, height, target_1, target_2), (world, _, *sides)) in enumerate(cases):
        speed = together([speeds[at] for speeds in reports])
        tile = f", tiles of {speed['recast_tile']}" if speed["recast_tile"] else ""
        yield (f"{world}{tile}{', one-sided' if sides else ''}", f"{cell} / {height}", spread(speed["recast_ms"]),
               spread(speed["throng_1_ms"]), spread(speed["throng_2_ms"]),
               verdict(speed["ratio_1"], target_1), verdict(speed["ratio_2"], target_2),
               f"{speed['recast_walkable_m2']:.0f} / {speed['throng_walkable_m2']:.0f}")


def far_rows():
    for cell, height, _, _ in SETTINGS:
        far = run_json(BENCH, WORLDS / "recast/dungeon.obj", "--far-triangle", "--cell", cell, "--cell-height", height,
                       "--json")["far_triangle"]
        for name in ("Recast", "throng"):
            shift = far[name.lower()]
            yield (f"{cell} / {height}", name, shift["floors"], shift["moved"], shift["lost"],
                   f"{shift['largest_m']:.3f} m")


def flat_model():
    """A flat square of 100 m: the bytes of an empty floor."""
    path = WORK / "flat.obj"
    WORK.mkdir(parents=True, exist_ok=True)
    path.write_text("v 0 0 0\nv 100 0 0\nv 100 0 100\nv 0 0 100\nf 1 4 3\nf 1 3 2\n")
    return path


def byte_rows():
    models = [("flat", flat_model(), "none", 4)]
    models += [(world, WORLDS / f"recast/{world}.obj", tiling, 900) for world, tiling in SPEED]
    for world, model, tiling, limit in models:
        row = run_json(BENCH, model, "--bytes", "--tiling", "none" if tiling == "none" else "128", "--json")["bytes"]
        ours = row["throng_bytes_per_m2"]
        yield (world, f"{ours:.1f}, target <= {limit}: {'met' if ours <= limit else 'MISSED'}",
               f"{row['recast_bytes_per_m2']:.1f}", f"{row['recast_bytes_per_m2'] / max(1e-9, ours):.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", default=5, type=int)
    parser.add_argument("--processes", default=3, type=int)
    options = parser.parse_args()
    runs, processes = options.runs, options.processes
    if not WORLDS.is_dir():
        sys.exit(f"{WORLDS} is missing: the comparison needs its recast/*.obj")
    if not BENCH.exists():
        sys.exit(f"{BENCH} is missing: run scripts/build release -- --target bench_recast")
    say(f"{processes} processes of {runs} alternating runs each")
    text = (f"Machine: {machine()}. {processes} processes of {runs} alternating runs each, one process after the other, all cases in turn; "
            "median of medians (smallest to largest of all), ms.\n\n")
    text += table(["world", "cell / height [m]", "Recast, 1 thread", "throng, 1 thread", "throng, 2 threads",
                   "ratio, 1 thread", "ratio, 2 threads", "walkable m2, Recast / throng"], speed_rows(runs, processes))
    text += ("\n\nRecast takes a triangle for floor only if it faces up as it is wound; throng ignores winding without `--one-sided`, "
             "and so also keeps the tops of ceilings. Walkable areas differ accordingly.")
    text += ("\n\nHeights far apart: `dungeon`, and the same with one triangle 2 km below it. Floors that "
             "moved by more than a cell's height (Recast) or a millimetre (throng), or whose column has none any more.\n\n")
    text += table(["cell / height [m]", "", "floors", "moved", "lost", "largest move"], far_rows())
    text += ("\n\nBytes for each walkable square metre of the adult at 0.1 m, four classes: our zone files, and four compact "
             "heightfields (cells, spans, areas) of Recast.\n\n")
    text += table(["world", "throng", "Recast", "ratio"], byte_rows())
    write_between("recast_table", text)


main()
