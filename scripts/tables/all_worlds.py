# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""The worlds that everything is tested on: the built-in ones and the models in ../shared/worlds."""
from results_page import WORK, WORLDS

BUILTIN = ["cube", "stairs", "garage", "bridge", "church", "powerplant", "city", "maze", "landscape"]
Z_UP = ["--up", "z"]
# Model, options. Axes and units as in the folder's README; the rest takes the format's own.
MODELS = [
    ("recast/nav_test.obj", []),
    ("recast/dungeon.obj", []),
    ("recast/undulating.obj", []),
    ("recast/city400.obj", []),
    ("sponza/sponza.obj", []),
    ("buildings/parking_garage.dae", []),
    ("buildings/powerplant.dae", []),
    ("buildings/school.dae", []),
    ("buildings/duplex_arch.ifc", []),
    ("buildings/duplex_arch.obj", []),
    ("buildings/office_a.ifc", []),
    ("buildings/office_a.obj", []),
    ("buildings/schependomlaan.obj", ["--scene", "no_rooms.toml"]),
    ("buildings/wd1_psup.obj", Z_UP),
    ("cities/delft.city.json", []),
    ("cities/rotterdam_subset.city.json", []),
    ("cities/denhaag_01.obj", Z_UP),
    ("cities/lod3_railway.obj", Z_UP),
    ("cities/parking_garage.gml", []),
    ("cities/road_over_bridge.gml", []),
    ("quake3/am_thornish.bsp", []),
    ("quake3/oa_dm5.bsp", []),
    ("bezier/teapot.bpt", []),
    ("nel", []),
]
# Scene files that some models need: room volumes of building models are not solid.
SCENES = {"no_rooms.toml": '[[rule]]\nnode = "IfcSpace*"\nkind = "ignored"\n'}


def worlds():
    """Name, model and options of each world that is there; writes the scene files that some need."""
    WORK.mkdir(parents=True, exist_ok=True)
    for file, text in SCENES.items():
        (WORK / file).write_text(text)
    for name in BUILTIN:
        yield name, f"builtin:{name}", []
    for name, options in MODELS:
        if (WORLDS / name).exists():
            yield name, WORLDS / name, [WORK / word if word in SCENES else word for word in options]
