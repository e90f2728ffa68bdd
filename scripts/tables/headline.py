# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Copies the first figures of docs/results.md into README.md and draws its pictures; run it after the others.

scripts/results headline [--no-picture] [--print]"""
import argparse
import re
import sys

from results_page import PROGRAM, ROOT, WORK, WORLDS, run_json, write_between

RESULTS = (ROOT / "docs/results.md").read_text()


def rows(marker):
    """The rows of the tables between two markers, each a dictionary by column."""
    found, head = [], None
    for line in RESULTS.split(f"<!-- begin {marker} -->")[1].split(f"<!-- end {marker} -->")[0].splitlines():
        if not line.startswith("|"):
            head = None
        elif head is None:
            head = [cell.strip() for cell in line.strip("|").split("|")]
        elif not line.startswith("|---"):
            found.append(dict(zip(head, (cell.strip() for cell in line.strip("|").split("|")))))
    return found


def first_number(text):
    return re.search(r"[\d.]+", text).group()


def bake_line():
    fine = [row for row in rows("recast_table") if row.get("cell / height [m]") == "0.1 / 0.1" and "ratio, 1 thread" in row
            and "one-sided" not in row["world"]]
    if not fine:
        return
    ratios = {row["world"].split(",")[0]: first_number(row["ratio, 1 thread"]) for row in fine}
    (first, ratio), *others = ratios.items()
    listed = ", ".join([f"{ratio} times as fast on `{first}`", *(f"{ratio} times on `{world}`" for world, ratio in others)])
    yield f"**Bake** beside Recast's, one thread each, 0.1 m cells: throng is {listed}."


def crowd_line():
    walks = [row for row in rows("crowd_table") if "ours, 2 threads" in row]
    if not walks:
        return
    last = walks[-1]
    count = f"{int(last['avatars']):,}".replace(",", " ")
    yield (f"**{count} wanderers** on two threads: {last['ours, 2 threads']} ns an avatar a step, occupancy "
           f"included ([ML06], 2006: {last['[ML06] ns an avatar']} ns); {last['faults']} in a wall or in another.")


def goals_line():
    walks = [row for row in rows("goals_table") if "ns a step, 2 threads" in row]
    checks = [row for row in rows("many_steps_table") if row["scene"] == "all"]
    if not walks or not checks:
        return
    last = walks[-1]
    count = f"{int(last['avatars']):,}".replace(",", " ")
    steps = checks[-1]["of these checked"].replace(",", " ")
    yield (f"**{count} with goals of their own** that avoid each other: {first_number(last['ns a step, 2 threads'])} ns each a step, two threads. "
           f"{steps} avatar-steps in {checks[-1]['runs']} runs checked one by one: {checks[-1]['overlaps']} overlaps, "
           f"{checks[-1]['walls entered']} walls entered.")


def proof_line():
    text = RESULTS.split("<!-- begin verify_table -->")[1].split("<!-- end verify_table -->")[0]
    counts = re.search(r"(\d+) tests of (\d+) worlds", text)
    if not counts:
        return
    worlds = rows("verify_table")
    entered, unsupported = (sum(int(row[name]) for row in worlds if row[name].isdigit())
                            for name in ("entered", "unsupported"))
    yield (f"**Proof**: {int(counts[1]) / 1e6:.1f} million places and moves in {counts[2]} worlds tested against the source triangles: "
           f"{entered} bodies in solids, {unsupported} without floor.")


def paths_line():
    found = {row["world, ours by"].removesuffix(", labels"): row for row in rows("detour_table") if row["world, ours by"].endswith(", labels")}
    city = [row for row in rows("city_table") if row.get("apart [m]") == "10000"]
    if not found or not city:
        return
    listed = ", ".join(f"{float(first_number(row['ratio'])):.1f} on `{world}` ({row['to make ours']})" for world, row in found.items())
    searches = [row for row in rows("detour_table") if row["world, ours by"].endswith(", search")]
    searched = ", ".join(f"{float(first_number(row['ratio'])):.2f} on `{row['world, ours by'].removesuffix(', search')}`" for row in searches)
    shorter = max(float(first_number(row["length, ours / Detour's"])) for row in found.values())
    yield (f"**Paths** beside Detour's, whole queries, one thread; queries a second, throng's / Detour's: with hub labels {listed}, "
           f"the time and memory to make them in brackets; by search, without labels, {searched}. Mean lengths are at most {shorter:.3f} of Detour's. "
           f"10 km through a city of 100 km2, with an overlay over zones ({city[-1]['to make, bytes']}): {first_number(city[-1]['median [ms]'])} ms.")


def landscape_line():
    found = [row for row in rows("landscape_table") if row["world"].startswith("nel") and row["cell [m]"] == "0.25"]
    if len(found) < 2:
        return
    ground, nodes = found[0], found[-1]
    yield (f"**A real Bezier landscape** of 96 zones, 0.25 m cells, two threads, with reading: {ground['whole, ms a zone']} ms a zone, "
           f"{nodes['whole, ms a zone']} with nodes and links ([PACS00], 2000: more than two minutes).")


def picture():
    WORK.mkdir(parents=True, exist_ok=True)
    world, walk, image = WORK / "readme.throng", WORK / "readme.csv", ROOT / "docs/images/garage.png"
    image.parent.mkdir(exist_ok=True)
    run_json(PROGRAM, "bake", "builtin:garage,size=60,levels=4", "-o", world, "--rebuild", "--json")
    run_json(PROGRAM, "run", world, "--avatars", 1500, "--steps", 100, "--trajectories", walk, "--json")
    run_json(PROGRAM, "picture", world, "--avatars", walk, "--width", 1400, "--title", "garage", "-o", image, "--json")
    walk.unlink()


TOWN = """# People stroll through the streets of a part of The Hague.
world = "{world}"
seconds = 60
paths = "zones"

[[area]]
name = "town"
box = [325, -490, 540, -310]
y = [2, 6.5]

[[density]]
name = "streets"
box = [325, -490, 540, -310]
y = [2, 6.5]
pixel = 1
paint = [{{ area = "town", weight = 100 }}]

[[profile]]
name = "walker"
speed = {{ normal = [1.34, 0.26], within = [0.7, 2] }}

[[journey]]
name = "stroll"
repeat = true
stages = [{{ density = "streets" }}]

[[source]]
name = "people"
density = "streets"
profile = "walker"
journey = "stroll"
count = 9000
"""


def crowd_pictures():
    """Frames of the viewer: a real city and the garage, with the people of ../shared/characters; unchanged where these are missing."""
    model, people = WORLDS / "cities/denhaag_01.obj", sorted((WORLDS.parent / "characters").glob("*.fbx"))
    if not model.exists() or not people:
        return
    world, town = WORK / "town.throng", WORK / "town.toml"
    size = ["--width", 1600, "--height", 900, "--json"]
    for character in people:
        size += ["--character", character]
    run_json(PROGRAM, "bake", model, "--up", "z", "-o", world, "--cell", 0.2, "--json")
    town.write_text(TOWN.format(world=world.name))
    run_json(PROGRAM, "view", town, "--source", model, "--up", "z", "--after", 4, "--camera", "338,44,-336,412,2,-396",
             "--picture", ROOT / "docs/images/city.png", *size)
    run_json(PROGRAM, "view", "builtin:garage,size=60,levels=4", "--avatars", 6000, "--near", 30, "--after", 6, "--camera", "-14,26,-22,26,4,26",
             "--picture", ROOT / "docs/images/garage_crowd.png", *size)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--no-picture", action="store_true", help="only the figures")
    parser.add_argument("--print", action="store_true", help="print the figures, write and draw nothing")
    options = parser.parse_args()
    lines = [*bake_line(), *paths_line(), *landscape_line(), *crowd_line(), *goals_line(), *proof_line()]
    if not lines:
        sys.exit("headline: docs/results.md has no tables yet; run the scripts that it names")
    text = "\n".join(f"- {line}" for line in lines)
    if options.print:
        print(text)
        return
    if not options.no_picture:
        picture()
        crowd_pictures()
    write_between("headline", text, "README.md")


main()
