# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Puts objects on a Bezier landscape: which nodes stay as they are, and do bodies enter any of the objects?

scripts/results objects [--threads T] [--samples N]"""
import argparse
import math
import random
import shutil

from results_page import PROGRAM, WORK, human, machine, run_json, table, write_between

SIDE = 480  # [m]
LANDSCAPE = f"builtin:landscape,size={SIDE},seed=3"
OBJECTS = 200


def box(x, z, low, high, width, depth, angle):
    """Corners of a box that stands upright, turned around its middle. [m]"""
    c, s = math.cos(angle), math.sin(angle)
    return [(x + dx * c - dz * s, y, z + dx * s + dz * c) for y in (low, high)
            for dx, dz in ((-width, -depth), (width, -depth), (width, depth), (-width, depth))]


def objects(count):
    """Poles, houses, roofs and bridges, slabs, walls: on the ground, in it, over it and under it."""
    draw = random.Random(5)
    for i in range(count):
        x, z, angle = draw.uniform(10, SIDE - 10), draw.uniform(10, SIDE - 10), draw.uniform(0, math.pi)
        yield (box(x, z, -40, 60, 0.15, 0.15, angle), box(x, z, -40, draw.uniform(5, 30), 3, 5, angle),
               box(x, z, draw.uniform(-10, 25), draw.uniform(26, 27), 8, 1.5, angle), box(x, z, -40, draw.uniform(0, 20), 2, 2, angle),
               box(x, z, -40, draw.uniform(-5, 15), 6, 0.3, angle))[i % 5]


def write_obj(path, boxes):
    faces = (1, 2, 3, 4), (5, 8, 7, 6), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 8, 4), (4, 8, 5, 1)
    lines = []
    for n, corners in enumerate(boxes):
        lines += [f"v {x:.3f} {y:.3f} {z:.3f}" for x, y, z in corners]
        lines += ["f " + " ".join(str(8 * n + k) for k in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def node_files(folder):
    return {path.name: path.read_bytes() for path in (folder / "nodes").glob("zone_*")}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--threads", default=2, type=int)
    parser.add_argument("--samples", default=20_000, type=int)
    options = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    folder, model = WORK / "objects.throng", WORK / "objects.obj"
    shutil.rmtree(folder, ignore_errors=True)
    scenes = [("none", []), ("a pole in the middle", [box(SIDE / 2, SIDE / 2, -40, 60, 0.15, 0.15, 0)]),
              ("a pole in the middle of a zone at a corner", [box(80, 80, -40, 60, 0.15, 0.15, 0)]),
              (f"{OBJECTS} of five kinds", list(objects(OBJECTS)))]
    bare, rows = {}, []
    for name, boxes in scenes:
        write_obj(model, boxes)
        models = [LANDSCAPE] + ([model] if boxes else [])
        bake = run_json(PROGRAM, "bake", *models, "-o", folder, "--cell", 0.25, "--nodes", "--node-size", 1, "--threads", options.threads, "--json")
        sources = [word for source in models for word in ("--source", source)]
        proof = run_json(PROGRAM, "verify", folder, *sources, "--nodes", "--samples", options.samples, "--json")
        files = node_files(folder)
        bare = bare or files
        same = sum(files.get(key) == data for key, data in bare.items())
        rows.append(row(name, bake, proof, same, len(bare)))
        if boxes:  # Each beside the bare landscape.
            run_json(PROGRAM, "bake", LANDSCAPE, "-o", folder, "--cell", 0.25, "--nodes", "--node-size", 1, "--threads", options.threads, "--json")
    shutil.rmtree(folder)
    model.unlink()
    write_between("objects_table", f"Machine: {machine()}. `{LANDSCAPE}`, cells of 0.25 m, nodes of 1 m, four classes, zones of 160 m. "
                  f"{options.samples} places a class are tested with the exact body against all triangles.\n\n" +
                  table(["objects", "nodes", "bytes", "zones kept / with the same bytes / of", "links over holes tested", "faults"], rows))


def row(name, bake, proof, same, zones):
    tests = proof["classes"]
    faults = sum(test[key] for test in tests for key in ("entered", "unsupported", "steeper", "lower", "one_way"))
    return (name, bake["nodes"], human(bake["node_bytes"]), f"{bake['node_zones_reused']} / {same} / {zones}",
            sum(test["links_over_holes"] for test in tests), f"{faults}: {'met' if faults == 0 else 'MISSED'}")


main()
