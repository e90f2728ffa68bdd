# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Runs crowds that ranks of mpirun share, weak and strong, beside threads of one process: time, bytes, memory, hashes.

scripts/results rank_runs [--size METRES] [--avatars A_RANK] [--ranks 1,2,...] [--steps N] [--runs N] [--print]"""
import argparse
import os
import statistics
import subprocess
import sys

from results_page import PROGRAM, WORK, human, machine, run_json, table, write_between

MPIRUN = ["mpirun", "--oversubscribe", *(["--allow-run-as-root"] if os.geteuid() == 0 else [])]
NEAR = 60  # m: max distance of goals


def measure(world, avatars, ranks, threads, steps):
    pinned = [*MPIRUN, "-n", ranks, "--bind-to", "core" if threads == 1 else "none"] if ranks > 1 else []
    words = [PROGRAM, "run", world, "--avatars", avatars, "--near", NEAR, "--steps", steps, "--threads", threads, "--zones",
             "--ignore-jams", "--json"]
    one_core = ["taskset", "-c", "0"] if ranks == 1 and threads == 1 else []
    return run_json(*pinned, *one_core, *words)


def spread(values, digits=0):
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", default=1500, type=int)
    parser.add_argument("--avatars", default=500_000, type=int)
    parser.add_argument("--ranks", default="")
    parser.add_argument("--steps", default=20, type=int)
    parser.add_argument("--runs", default=3, type=int)
    parser.add_argument("--print", action="store_true", help="print the table, write nothing")
    options = parser.parse_args()
    cores = len(os.sched_getaffinity(0))
    ranks = [int(n) for n in options.ranks.split(",")] if options.ranks else [n for n in (1, 2, 4, 8, 16) if n <= cores]
    most = options.avatars * max(ranks)
    WORK.mkdir(parents=True, exist_ok=True)
    world = WORK / f"city{options.size}.throng"
    if not world.exists():
        subprocess.run([PROGRAM, "bake", f"builtin:city,size={options.size},seed=3", "-o", world], check=True,
                       stdout=subprocess.DEVNULL)
    # Name, avatars, ranks, threads of each; what the time of an avatar step is compared with.
    cases = [(f"weak: {n} x {options.avatars}", options.avatars * n, n, 1, f"weak: 1 x {options.avatars}") for n in ranks]
    cases += [(f"{most} by {n} ranks of 1 thread", most, n, 1, f"{most} by 1 process of {n} threads") for n in ranks if n > 1]
    cases += [(f"{most} by 1 process of {n} threads", most, 1, n, None) for n in ranks if n > 1]
    cases = [case for case in cases if case[1] < most or case[2] > 1 or case[3] > 1 or len(ranks) == 1]
    found = {name: [] for name, *_ in cases}
    for _ in range(options.runs):
        done = {}  # The largest weak run is a strong one, too.
        for name, avatars, n, threads, _ in cases:
            if (avatars, n, threads) not in done:
                done[avatars, n, threads] = measure(world, avatars, n, threads, options.steps)
            found[name].append(done[avatars, n, threads])
    hashes = {}
    for name, avatars, *_ in cases:
        hashes.setdefault(avatars, set()).update(report["state_hash"] for report in found[name])
    rows, met = [], True
    for name, avatars, n, threads, beside in cases:
        reports = found[name]
        # Wall clock of a step by the avatars of one rank or thread: what a core does in it.
        times = [report["ns_per_avatar_step_median"] * n * threads for report in reports]
        share = ""
        if beside and beside in found and beside != name:
            of = found[beside]
            other = [r["ns_per_avatar_step_median"] * (n if "process" in beside else 1) for r in of]
            ratios = [a / b for a, b in zip(other, times)]
            share = spread(ratios, 2)
            met = met and statistics.median(ratios) >= 0.9
        rows.append((name, spread(times), share,
                     spread([r["sent_bytes"] / 1000 for r in reports], 1) if n > 1 else "",
                     human(max(r["crowd_bytes"] for r in reports)), human(max(r["peak_bytes"] for r in reports)),
                     spread([r["most_avatars"] * n / avatars for r in reports], 2) if n > 1 else ""))
    same = all(len(of) == 1 for of in hashes.values())
    text = (f"Machine: {machine()}. Built-in city, {options.size} m wide, random goals at most {NEAR} m away, paths by zones, "
            f"{options.steps} steps of 0.1 s; ranks pinned to a core each. {options.runs} alternating runs; median (smallest "
            f"to largest). Hashes are the same for the same avatars: {'yes' if same else 'NO'}.\n\n")
    text += table(["run", "ns a step, by avatars of a core", "efficiency beside one thread, or as many threads",
                   "sent by a rank in a step [kB]", "crowd, of rank 0", "peak memory, of rank 0", "most avatars of a rank by mean"], rows)
    if options.print:
        print(text)
    else:
        write_between("rank_runs_table", text)
    sys.exit(0 if met and same else 1)


main()
