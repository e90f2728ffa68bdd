# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Makes atlases of the built-in figure and of each character: sizes and PSNR; then times culling and packing.

The characters are those of ../shared/characters. Writes the tables of impostors in docs/results.md.

scripts/results atlas"""
import argparse
import shutil
import statistics
import sys

from results_page import PROGRAM, ROOT, WORK, machine, run_json, say, table, write_between

CHARACTERS = ROOT.parent / "shared/characters"
MIB = 2**20
MAX_SQUARE, MAX_COMPRESSED, MIN_PSNR = 10, 2.5, 35  # [MiB] of 16-bit colour in equal squares (the seed's layout), [MiB], [dB]
MAX_PACK = 8  # [ms]


def mib(count):
    return f"{count / MIB:.2f}"


def cell(row):
    quality = "exact" if row["psnr"] is None else f"{row['psnr']:.1f} dB"
    return f"{mib(row['sheet_bytes'])} / {mib(row['packed_bytes'])}, {quality}"


def pack_rows():
    """Medians of single runs: other load on the machine shows in the spread."""
    bench = ROOT / "build/release/bench/throng_bench"
    priority = ["chrt", "-f", "50"] if shutil.which("chrt") else []
    times = {}
    for _ in range(7):
        report = run_json(*priority, bench, "--benchmark_filter=pack_impostors", "--benchmark_format=json", "--benchmark_min_time=0.2")
        for run in report["benchmarks"]:
            words = dict(word.split(":") for word in run["name"].split("/") if ":" in word)
            times.setdefault((int(words["avatars"]), int(words["overview"]), int(words["workers"])), []).append((run["real_time"], int(run["seen"])))
    met = True
    for (avatars, overview, workers), found in sorted(times.items()):
        found.sort()
        median = statistics.median(ms for ms, _ in found)
        verdict = ""
        if avatars == 1_000_000 and workers == 2:
            verdict = f", target <= {MAX_PACK}: {'met' if median <= MAX_PACK else 'MISSED'}"
            met = met and median <= MAX_PACK
        yield (avatars, "from above, all" if overview else "from the street", found[0][1], workers,
               f"{median:.2f} ({found[0][0]:.2f} to {found[-1][0]:.2f}){verdict}"), met


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    rows, met = [], True
    for path in [None, "--parts", *sorted(CHARACTERS.glob("*.*"))]:
        name = {None: "built-in figure", "--parts": "with seven parts to wear"}.get(path) or path.name
        report = run_json(PROGRAM, "atlas", *([path] if path else []), "-o", WORK / "figure.atlas", "--json")
        formats = {row["format"]: row for row in report["formats"]}
        sheet = formats["rgb5a1"]["sheet_bytes"] <= MAX_SQUARE * MIB
        packed = [formats[name]["packed_bytes"] <= MAX_COMPRESSED * MIB and formats[name]["psnr"] >= MIN_PSNR for name in ("bc3", "etc2")]
        encoded = run_json(PROGRAM, "atlas", *([path] if path else []), "-o", WORK / "figure.atlas", "--format", "etc2", "--json")
        met = met and sheet and all(packed)
        rows.append((name, report["triangles"], report["bones"], f"{report['clips'][0]['stride']:.2f}", *map(cell, report["formats"]),
                     mib(report["normal_bytes"]), mib(report["mask_bytes"]), f"{report['seconds']:.1f}", f"{encoded['seconds']:.1f}",
                     ", ".join("met" if one else "MISSED" for one in (sheet, *packed))))
    head = ("character", "triangles", "bones", "stride [m]", "rgba8", "rgb5a1, as in the seed", "bc1", "bc3", "etc2a1", "etc2", "normals, BC5 or EAC", "masks",
            "seconds, bc3", "etc2", f"rgb5a1 in equal squares <= {MAX_SQUARE}; bc3, etc2 packed <= {MAX_COMPRESSED} at >= {MIN_PSNR} dB")
    write_between("atlas_table", f"Machine: {machine()}. 10 frames of a walk, 16 x 8 views of 64 x 64 texels, mirrored to 32 x 8. MiB.\n\n" + table(head, rows))
    packs = list(pack_rows())
    met = met and packs[-1][1]
    write_between("pack_table", f"Machine: {machine()}. 7 runs; median (smallest to largest).\n\n" +
                  table(("avatars", "seen", "in the picture", "threads", "ms"), [row for row, _ in packs]))
    say("done")
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
