# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""A bake that is killed at any moment: the next one finishes it, with the bytes of an undisturbed one.

python3 killed_bake_test.py build/release/throng [POINTS [OPTION...]], as --nodes --fly"""
import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
POINTS = int(sys.argv[2]) if len(sys.argv) > 2 else 40
EXTRA = sys.argv[3:]
OPTIONS = ["--cell", "0.1", "--zone", "6.4", "--threads", "1", "--json", *EXTRA]


def write_model(path, crates):
    """Hilly ground of 80 x 80 m and crates on it."""
    lines, count = [], 0

    def quad(*corners):
        nonlocal count
        lines.extend(f"v {x:.3f} {y:.3f} {z:.3f}" for x, y, z in corners)
        lines.append(f"f {count + 1} {count + 2} {count + 3} {count + 4}")
        count += 4

    def height(x, z):
        return 0.03 * ((x * 7 + z * 5) % 13)

    for z in range(80):
        for x in range(80):
            quad(*((a, height(a, b), b) for a, b in ((x, z), (x, z + 1), (x + 1, z + 1), (x + 1, z))))
    for x, z in crates:
        quad((x, 1, z), (x, 1, z + 1), (x + 1, 1, z + 1), (x + 1, 1, z))
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def bake(model, world, *options):
    done = subprocess.run([PROGRAM, "bake", model, "-o", world, *OPTIONS, *options], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def content(world):
    return {str(file.relative_to(world)): file.read_bytes() for file in world.rglob("*") if file.is_file()}


def ground(files):
    """All but the nodes, which are made when the ground is in its place."""
    return {name: data for name, data in files.items() if not name.startswith("nodes")}


def main():
    draw = random.Random(5)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        old_model, new_model = folder / "old.obj", folder / "new.obj"
        write_model(old_model, [])
        # Crates in half of the zones: some are reused, and there is something to kill.
        write_model(new_model, [(x, z) for z in range(1, 80, 6) for x in range(3, 46, 6)])
        empty, old, world = folder / "empty", folder / "old.throng", folder / "w.throng"
        bake(old_model, old)
        references = {}
        for start in (empty, old):
            seconds = 1e9
            for _ in range(3):
                shutil.rmtree(world, ignore_errors=True)
                if start.exists():
                    shutil.copytree(start, world)
                begin = time.monotonic()
                report = bake(new_model, world)
                seconds = min(seconds, time.monotonic() - begin)
            assert (report["zones_reused"] > 0) == start.exists(), report
            references[start] = (content(world), seconds)
            print(f"from {start.name}: {seconds:.2f} s, {report['zones_baked']} baked, {report['zones_reused']} reused")
        assert references[empty][0] == references[old][0], "what was there before shows in the bytes"
        assert bake(new_model, world, "--rebuild")["zones_reused"] == 0
        assert content(world) == references[empty][0]
        before = content(old)
        killed = resumed = in_graph = in_nodes = opened = refused = without_nodes = 0
        # On a busy machine few points may fall where it matters: then there are more of them.
        for point in range(12 * POINTS):
            if point >= POINTS and killed >= POINTS // 4 and resumed >= 2 and in_graph >= 1:
                break
            points = point + 1
            start = (empty, old)[point % 2]
            reference, seconds = references[start]
            shutil.rmtree(world, ignore_errors=True)
            if start.exists():
                shutil.copytree(start, world)
            for _ in range(1 + point // 2 % 2):  # Some are killed twice.
                with subprocess.Popen([PROGRAM, "bake", new_model, "-o", world, *OPTIONS],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                    time.sleep(draw.uniform(0, seconds * 1.02))
                    process.kill()
                    killed += process.wait() != 0
                check = subprocess.run([PROGRAM, "info", world, "--check"], capture_output=True, text=True,
                                       check=False)
                if check.returncode == 0:
                    opened += 1
                    now, whole = ground(content(world)), (ground(before), ground(reference))
                    assert now in whole or (world / "journal").exists(), point
                    without_nodes += "--nodes" in EXTRA and not (world / "nodes").exists()
                else:
                    refused += 1
                    assert check.returncode == 2 and len(check.stderr.splitlines()) == 1, check.stderr
                    assert start == empty, f"point {point}: the old world is gone: {check.stderr}"
            resumed += 0 < len(list(folder.glob("w.throng.part/*.thz")))
            in_nodes += 0 < len(list(world.glob("nodes.part/*.thn")))
            in_graph += 0 < len(list(folder.glob("w.throng.part/*.th[rl]")))
            bake(new_model, world)
            assert content(world) == reference, f"point {point}: other bytes than undisturbed"
            left = {file.name for file in folder.iterdir()} - {"old.obj", "new.obj", "old.throng", "w.throng"}
            assert not left, f"point {point}: left behind: {left}"
        print(f"{points} points: {killed} killed, {resumed} with zones to resume from, {in_graph} while "
              f"the graph was made, {in_nodes} with nodes to resume from; the world opened {opened} "
              f"times, {without_nodes} of them without its nodes, and was refused {refused} times")
        assert killed >= POINTS // 4 and resumed >= 2 and in_graph >= 1, "too few bakes were killed where it matters"
        assert "--nodes" not in EXTRA or POINTS < 100 or in_nodes >= 1, "no bake was killed in its nodes"


main()
