# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Paths that the program finds: on foot, over nodes, through the air; and what it prints if there is none.

python3 program_path_test.py build/release/throng"""
import json
import subprocess
import unittest

from program_case import ProgramCase


class ProgramPath(ProgramCase):
    def test_a_path_through_the_air_lists_its_segments_and_bad_ends_are_refused(self):
        self.assert_refused(self.run_throng("path", self.world, "--from", "14,0,8", "--to", "30,0,8", "--fly"), "baked without air")
        done = self.run_throng("bake", "builtin:cube", "--fly", "--cell", "0.2", "-o", "cube.throng", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(json.loads(done.stdout)["air_bytes"], 0)
        air = json.loads(self.run_throng("info", "cube.throng", "--json").stdout)["air"]
        self.assertAlmostEqual(air["cell"], 0.4)

        def fly(start, goal, *more):
            return self.run_throng("path", "cube.throng", "--from", start, "--to", goal, "--class", "flyer", "--fly", *more)

        found = json.loads(fly("2,3,2", "4,3,4", "--json").stdout)
        self.assertEqual((found["end"], found["segments"]), ("reached", ["fly"]))
        ends = ("path", "cube.throng", "--from", "2,3,2", "--to", "4,3,4", "--class", "flyer", "--json")
        self.assertEqual(json.loads(self.run_throng(*ends).stdout)["segments"], ["fly"])
        self.assert_refused(self.run_throng(*ends, "--on-foot"), "--from", "can stand")
        self.assert_refused(self.run_throng(*ends, "--on-foot", "--fly"), "--on-foot")
        self.assert_refused(fly("nan,3,2", "4,3,4"), "--from", "finite")
        self.assert_refused(fly("2,3,2", "400,3,4"), "--to", "outside")
        self.assert_refused(fly("2,3,2", "4,900,4"), "--to", "neither in the air nor on the ground")
        self.assert_refused(fly("0.05,3,2", "4,3,4"), "--from", "neither in the air nor on the ground")
        self.assert_refused(self.run_throng("path", "cube.throng", "--from", "2,3,2", "--to", "4,3,4", "--class", "adult", "--fly"),
                            "does not fly")
        self.assert_refused(fly("2,3,2", "4,3,4", "--block", "2,2,2,4,4,4"), "--from", "--block")
        self.assert_refused(fly("2,3,2", "4,3,4", "--block", "3.8,2,3.8,4,4,4"), "--to", "--block")
        self.assert_refused(fly("2,3,2", "4,3,4", "--block", "2,2,2,4,2,4"), "--block", "opposite corners")
        self.assert_refused(fly("2,3,2", "4,3,4", "--slope-cost", "1"), "--slope-cost", "ground")
        for option in (("--off-mesh-link", "2,3,2,4,3,4"), ("--area", "2,2,2,4,4,4,5"), ("--area-cost", "5=2")):
            self.assert_refused(fly("2,3,2", "4,3,4", *option), option[0], "through the air (--fly) take only --block")
        around = json.loads(fly("2,3,2", "4,3,4", "--block", "2.9,2,2.9,3.1,9,3.1", "--json").stdout)
        self.assertEqual(around["end"], "reached")
        self.assertGreater(around["length"], found["length"] + 0.05)

    def test_a_flight_into_a_closed_room_reports_the_nearest_point(self):
        lines, sides = [], ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))
        for low, high in (((0, -1, 0), (20, 0, 8)), ((10, 0, 1), (16, 5, 7))):
            first = 8 * len(lines) // 14 + 1
            lines += ["v " + " ".join(str((high if k >> axis & 1 else low)[axis]) for axis in range(3)) for k in range(8)]
            lines += ["f " + " ".join(str(first + k) for k in side) for side in sides]
        (self.path / "room.obj").write_text("\n".join(lines) + "\n", encoding="ascii")
        done = self.run_throng("bake", "room.obj", "--fly", "--cell", "0.2", "-o", "room.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        path = ("path", "room.throng", "--from", "3,2,4", "--to", "13,2,4", "--class", "flyer", "--fly")
        done = self.run_throng(*path, "--json")
        self.assertEqual(done.returncode, 1, done.stderr)
        found = json.loads(done.stdout)
        self.assertEqual((found["end"], found["nearest"]["blocked_by"]), ("unreachable", "a wall, or too narrow"))
        self.assertEqual(found["points"][-1], found["nearest"]["place"])
        self.assertGreater(found["nearest"]["distance"], 3)  # Over the roof.
        self.assertLess(found["nearest"]["distance"], 4.5)
        self.assertAlmostEqual(found["cost"], found["length"])
        text = self.run_throng(*path).stdout
        self.assertIn("unreachable", text)
        self.assertIn("blocked by: a wall, or too narrow", text)

    def test_paths_lead_around_boxes_and_report_what_blocks_them(self):
        def path(goal, *more):
            done = self.run_throng("path", self.world, "--from", "14,0,8", "--to", goal, "--json", *more)
            return done.returncode, json.loads(done.stdout)

        code, straight = path("20,0,8")
        self.assertEqual((code, straight["end"]), (0, "reached"))
        code, around = path("20,0,8", "--block", "17,2,9,16,0,0")
        self.assertEqual((code, around["end"]), (0, "reached"))
        self.assertGreater(around["length"], straight["length"] + 0.5)
        self.assertGreater(max(z for _, _, z in around["points"]), 9.2)
        code, shut = path("20,0,8", "--block", "16,0,0,17,12,40")
        self.assertEqual((code, shut["end"]), (1, "unreachable"))
        self.assertEqual(shut["nearest"]["blocked_by"], "an obstacle")
        self.assertLess(shut["points"][-1][0], 16)
        code, link = path("20,0,8", "--block", "16,0,0,17,12,40", "--off-mesh-link", "15,0,8,18,0,8")
        self.assertEqual((code, [one["kind"] for one in link["links"]]), (0, ["off-mesh link"]))
        self.assertEqual(link["segments"][link["links"][0]["point"] - 1], "off-mesh link")
        code, dear = path("20,0,8", "--area", "16,-1,0,17,12,40,5", "--area-cost", "5=3")
        self.assertEqual(code, 0)
        self.assertAlmostEqual(dear["cost"], straight["cost"] + 2, delta=0.5)
        code, closed = path("20,0,8", "--area", "16,-1,0,17,12,40,5", "--area-cost", "5=inf")
        self.assertEqual((code, closed["nearest"]["blocked_by"]), (1, "an area of infinite cost"))
        text = self.run_throng("path", self.world, "--from", "14,0,8", "--to", "20,0,8", "--block", "16,0,0,17,12,40").stdout
        self.assertIn("blocked by: an obstacle (--block)", text)
        code, up = path("30,2.9,30", "--class", "wheelchair")
        self.assertEqual((code, up["end"], up["nearest"]["blocked_by"]), (1, "unreachable", "a gap"))
        ends = ["path", self.world, "--from", "14,0,8", "--to", "20,0,8"]
        self.assert_refused(self.run_throng(*ends, "--block", "13,0,7,15,2,9"), "--from", "--block")
        self.assert_refused(self.run_throng(*ends, "--block", "13,0,7,13,2,9"), "--block", "opposite corners")
        self.assert_refused(self.run_throng(*ends, "--area-cost", "1.5=2"), "--area-cost", "whole numbers")
        self.assert_refused(self.run_throng(*ends, "--off-mesh-link", "14,0,8,19,0,99"), "--off-mesh-link", "outside")

    def test_boxes_block_paths_over_nodes_too(self):
        done = self.run_throng("bake", "builtin:garage", "--cell", "0.2", "--nodes", "-o", "n.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        ends = ("path", "n.throng", "--nodes", "--from", "14,0,8", "--to", "20,0,8")

        def path(*options):
            done = self.run_throng(*ends, *options, "--json")
            return done.returncode, json.loads(done.stdout)["length"]

        code, straight = path()
        self.assertEqual(code, 0)
        code, around = path("--block", "17,2,9,16,0,0")
        self.assertEqual(code, 0)
        self.assertGreater(around, straight + 0.3)
        self.assertEqual(path("--block", "16,0,0,17,12,40")[0], 1)
        self.assert_refused(self.run_throng(*ends, "--block", "13,0,7,15,2,9", "--tolerance", "0.1"), "--from")
        verify = ("verify", "n.throng", "--source", "builtin:garage", "--samples", "40")
        box = ("--block", "16,0,0,17,2,9")
        done = self.run_throng(*verify, "--paths", "--nodes", *box, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_refused(self.run_throng(*verify, *box), "--block", "--paths")
        self.assert_refused(self.run_throng(*verify, "--paths", *box), "--block", "--nodes")

    def test_nodes_promise_how_tall_and_how_wide_a_body_passes(self):
        done = self.run_throng("bake", "builtin:garage", "--cell", "0.2", "--nodes", "-o", "n.throng")
        self.assertEqual(done.returncode, 0, done.stderr)

        def query(*options):
            done = self.run_throng("query", "n.throng", "--nodes", "--at", "14,0,8", *options, "--json")
            return done.returncode, json.loads(done.stdout)

        code, here = query()
        self.assertEqual(code, 0)
        self.assertEqual(here["clearance"]["classes"], ["adult", "child", "wheelchair"])  # Two of three metres are free.
        self.assertGreaterEqual(here["clearance"]["headroom"], 1.75)
        self.assertGreater(here["clearance"]["width"], 0.3)
        for body, fits in (("0.1,1", True), ("0.3,1.75", True), ("0.3,2.9", False), ("5,1", False), ("0.1,1,0.4,1", False)):
            code, answer = query("--body", body)
            self.assertEqual((code, answer["body"]["fits"]), (0 if fits else 1, fits), body)
        nowhere = self.run_throng("query", "n.throng", "--nodes", "--at", "14,1.5,8", "--radius", "0.2", "--json")
        self.assertEqual((nowhere.returncode, json.loads(nowhere.stdout)["place"]), (1, None))
        query_here = ("query", "n.throng", "--at", "14,0,8")
        self.assert_refused(self.run_throng(*query_here, "--body", "0.3,1"), "--body", "--nodes")
        self.assert_refused(self.run_throng(*query_here, "--nodes", "--random", "2"), "--nodes", "--random")
        self.assert_refused(self.run_throng(*query_here, "--nodes", "--body", "0,1"), "--body", "radius")
        self.assert_refused(self.run_throng("query", self.world, "--at", "14,0,8", "--nodes"), "no nodes", "--nodes")
        path = ("path", "n.throng", "--nodes", "--from", "14,0,8", "--to", "20,0,8")
        along = json.loads(self.run_throng(*path, "--json").stdout)["clearance"]
        self.assertIn("adult", along["classes"])
        self.assertLessEqual(along["width"], here["clearance"]["width"])
        self.assertIn("all along the ground is at most", self.run_throng(*path).stdout)
        plain, dear = (json.loads(self.run_throng(*path, *more, "--json").stdout) for more in ((), ("--narrow-cost", "9", "--low-cost", "9")))
        self.assertAlmostEqual(plain["cost"], plain["length"], places=6)
        self.assertGreater(dear["cost"], 2 * dear["length"])  # The garage has no room for giants.
        for option in ("--narrow-cost", "--low-cost"):
            self.assert_refused(self.run_throng(*path, option, "-1"), option)
            on_foot = ("path", "n.throng", "--from", "14,0,8", "--to", "20,0,8", option, "1")
            self.assert_refused(self.run_throng(*on_foot), option, "--nodes")

    def test_what_nodes_promise_is_summed_up_and_drawn(self):
        done = self.run_throng("bake", "builtin:cube", "--cell", "0.2", "--nodes", "--fly", "-o", "n.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        surface = json.loads(self.run_throng("surface", "n.throng", "--json").stdout)
        for of_class in surface["classes"]:
            for name in ("inclination", "height", "headroom", "width"):
                self.assertAlmostEqual(sum(one["area"] for one in of_class[name]), of_class["area"], places=3)
        self.assertIn("    headroom    at least", self.run_throng("surface", "n.throng").stdout)
        pictures = set()
        for more in ((), ("--cylinders",), ("--boxes",)):
            done = self.run_throng("picture", "n.throng", "--nodes", *more, "-o", "nodes.png")
            self.assertEqual(done.returncode, 0, done.stderr)
            pictures.add((self.path / "nodes.png").read_bytes())
        self.assertEqual(len(pictures), 3)
        self.assert_refused(self.run_throng("picture", "n.throng", "--cylinders", "-o", "x.png"), "--cylinders", "--nodes")
        self.assert_refused(self.run_throng("picture", self.world, "--boxes", "-o", "x.png"), "--boxes", "--nodes")

    def test_links_between_the_air_and_nodes_are_counted_and_verified(self):
        model = ("builtin:garage", "--cell", "0.25")
        self.assertEqual(self.run_throng("bake", *model, "--nodes", "--fly", "-o", "w.throng").returncode, 0)
        done = self.run_throng("surface", "w.throng", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        links = json.loads(done.stdout)["air_links"]
        self.assertGreater(links["leaves"], 200)
        self.assertGreaterEqual(links["links"], links["leaves"])
        self.assertEqual(links["leaf_sinks"], 0)
        self.assertIn(f"leaves of the air: {links['leaves']} linked", self.run_throng("surface", "w.throng").stdout)
        done = self.run_throng("verify", "w.throng", "--source", "builtin:garage", "--nodes", "--class", "flyer",
                               "--samples", "4000", "--json")
        self.assertEqual(done.returncode, 0, done.stdout)
        found = json.loads(done.stdout)["classes"][0]["air_links"]
        self.assertGreater(min(found["links"], found["places"]), 500)
        self.assertEqual([found[key] for key in ("blocked", "entered", "one_way", "sinks")], [0] * 4)
        done = self.run_throng("bake", *model, "--nodes", "-o", "w.throng")  # Without air there are none.
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("air_links", json.loads(self.run_throng("surface", "w.throng", "--json").stdout))
        self.assertEqual(list((self.path / "w.throng").rglob("*.thg")), [])

    def test_links_and_areas_hold_over_nodes_too(self):
        (self.path / "classes.toml").write_text(
            '[[class]]\nname = "adult"\n[[class]]\nname = "climber"\nclimb_slope = 90\n')
        done = self.run_throng("bake", "builtin:garage,levels=2", "--cell", "0.2", "--nodes", "--classes", "classes.toml", "-o", "n.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        all_across = "16,-1,0,17,12,40"
        for name, how in (("adult", ("--nodes",)), ("climber", ())):  # A climber always moves over nodes.
            ends = ("path", "n.throng", "--class", name, *how, "--from", "14,0,8", "--to", "20,0,8")

            def path(*options):
                done = self.run_throng(*ends, *options, "--json")
                self.assertIn(done.returncode, (0, 1), done.stderr)
                found = json.loads(done.stdout)
                self.assertEqual(found["end"], "unreachable" if done.returncode else "reached")
                self.assertIn("corridor", found)
                return found

            plain = path()
            self.assertAlmostEqual(plain["length"], 6, delta=0.3)
            self.assertEqual(path("--block", all_across)["end"], "unreachable")
            link = path("--block", all_across, "--off-mesh-link", "15,0,8,18,0,8")
            self.assertEqual(link["end"], "reached")
            used = [one["point"] for one in link["links"] if one["kind"] == "off-mesh link"]
            self.assertEqual([link["segments"][point - 1] for point in used], ["off-mesh link"])
            self.assertAlmostEqual(link["cost"], plain["cost"], delta=0.3)
            back = path("--block", all_across, "--off-mesh-link", "18,0,8,15,0,8")
            self.assertAlmostEqual(back["cost"], link["cost"], delta=0.01)
            # A metre that costs 3, a strip to walk around, and one that is closed.
            dear = path("--area", f"{all_across},5", "--area-cost", "5=3")
            self.assertAlmostEqual(dear["cost"], plain["cost"] + 2, delta=0.6)
            around = path("--area", "16,-1,0,17,2,9,5", "--area-cost", "5=20")
            self.assertGreater(around["length"], plain["length"] + 0.1)
            self.assertLess(around["cost"], plain["cost"] + 5)
            self.assertEqual(path("--area", f"{all_across},5", "--area-cost", "5=inf")["end"], "unreachable")
            self.assert_refused(self.run_throng(*ends, "--area", "13,-1,7,15,2,9,5", "--area-cost", "5=inf", "--tolerance", "0.1"),
                                "--from", "its ground is closed")
            self.assert_refused(self.run_throng(*ends, "--area-cost", "5=3"), "no --area has kind 5", "over nodes")
            self.assert_refused(self.run_throng(*ends, "--off-mesh-link", "15,0,8,18,90,8"), "--off-mesh-link", "no place on nodes")
            self.assert_refused(self.run_throng(*ends, "--area", "16,0,0,16,2,9,5"), "--area", "opposite corners")
            self.assert_refused(self.run_throng(*ends, "--area", "16,0,0,17,2,9,64"), "--area", "1 to 63")

    def test_ends_over_nodes_are_above_or_below_the_given_ones(self):
        done = self.run_throng("bake", "builtin:landscape,size=160", "--cell", "0.5", "--nodes", "-o", "h.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        ends = ("path", "h.throng", "--nodes", "--tolerance", "20", "--from", "20,5,20", "--to", "120,5,90")
        path = json.loads(self.run_throng(*ends, "--json").stdout)
        self.assertLess(max(path["beside"].values()), 0.001)
        for point, given in ((path["points"][0], (20, 20)), (path["points"][-1], (120, 90))):
            self.assertLess(abs(point[0] - given[0]) + abs(point[2] - given[1]), 0.001)
        text = self.run_throng(*ends).stdout
        self.assertNotIn("beside", text)
        # A point each --spacing: the text has the first and the last, --json has all.
        lines = [line for line in text.splitlines() if line.endswith(" deg")]
        self.assertEqual((len(lines), len(path["points"]) > 400), (16, True))
        self.assertIn(f"  ... {len(path['points']) - 16} more points: --json has all\n", text)
        for point, line in ((path["points"][7], lines[7]), (path["points"][-8], lines[8])):
            self.assertIn(", ".join(f"{v:.3f}" for v in point), line)
        wide = json.loads(self.run_throng(*ends, "--json", "--spacing", "4").stdout)
        self.assertLess(len(wide["points"]), len(path["points"]) / 2)
        self.assertLess(abs(wide["length"] - path["length"]), 0.01 * path["length"])
        self.assert_refused(self.run_throng(*ends, "--spacing", "0"), "--spacing: 0 is below 0.01")

    def test_paths_through_the_air_are_refused_by_world_and_class_alike(self):
        ends = ("--from", "2,0,2", "--to", "4,0,4")
        done = self.run_throng("bake", "builtin:cube", "--fly", "--cell", "0.2", "-o", "cube.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assert_refused(self.run_throng("path", self.world, *ends, "--fly"), f"{self.world}: --fly: ", "bake it again with --fly")
        self.assert_refused(self.run_throng("path", self.world, *ends, "--nodes"), f"{self.world}: ", "bake it again with --nodes")
        self.assert_refused(self.run_throng("path", "cube.throng", *ends, "--fly"), "cube.throng: --fly: class adult does not fly", "--class")
        self.assertEqual(self.run_throng("path", "cube.throng", *ends, "--fly", "--class", "flyer").returncode, 0)

    def test_options_of_nodes_are_checked_before_the_old_world_is_replaced(self):
        done = self.run_throng("bake", "builtin:stairs", "--cell", "0.2", "--nodes", "-o", "w.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        before = {p: p.read_bytes() for p in self.path.rglob("*") if p.is_file()}
        (self.path / "links.json").write_text('[{"from": [0, 0, 0], "to": [1, 0, 1], "class": "horse"}]')
        (self.path / "list.json").write_text("{}")
        again = ["bake", "builtin:garage", "--cell", "0.2", "-o", "w.throng"]
        self.assert_refused(self.run_throng(*again, "--nodes", "--node-size", "1000"), "size")
        self.assert_refused(self.run_throng(*again, "--off-mesh-links", "links.json"), "off-mesh link 1", "horse", "adult")
        self.assert_refused(self.run_throng(*again, "--off-mesh-links", "list.json"), "no list", '"from"')
        self.assert_refused(self.run_throng(*again, "--off-mesh-links", "missing.json"), "missing.json")
        # Whether a link has places only the new ground shows.
        (self.path / "far.json").write_text('[{"from": [0, 0, 0], "to": [900, 0, 0], "class": "adult"}]')
        for cell in ("0.2", "0.25"):
            done = self.run_throng("bake", "builtin:stairs", "--cell", cell, "-o", "w.throng", "--nodes", "--off-mesh-links", "far.json")
            self.assert_refused(done, "off-mesh link 1", "no place", "nothing was written")
            self.assertEqual({path.name for path in self.path.iterdir()}, {"w.throng", "links.json", "list.json", "far.json"})
            self.assertEqual({path for path in before} | {self.path / name for name in ("links.json", "list.json", "far.json")},
                             {path for path in self.path.rglob("*") if path.is_file()})
        for path, content in before.items():
            self.assertEqual(path.read_bytes(), content, path)

    def test_paths_are_verified_and_those_through_another_model_fail(self):
        done = self.run_throng("generate", "garage", "--levels", 2, "-o", "model.glb")
        self.assertEqual(done.returncode, 0, done.stderr)
        verify = ("verify", self.world, "--paths", "--samples", 40, "--json", "--source")
        done = self.run_throng(*verify, "model.glb")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads(done.stdout)
        self.assertTrue(report["passed"])
        for entry in report["classes"]:
            self.assertEqual(entry["over"], "level tiles")
            self.assertEqual(entry["pairs"], 40)
            self.assertGreater(entry["reached"], 10)
            self.assertEqual(sum(entry[fault] for fault in ("illegal", "entered", "unsupported", "broken", "disagree")), 0)
        done = self.run_throng(*verify, "builtin:maze")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertFalse(json.loads(done.stdout)["passed"])

    def test_components_come_from_the_files_of_the_bake_or_are_computed(self):
        def components(world):
            done = self.run_throng("components", world, "--at", "14,0,8", "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            return json.loads(done.stdout)
        copy = self.path / "copy.throng"
        subprocess.run(["cp", "-r", self.world, copy], check=True)
        on_disk = components(copy)
        self.assertTrue(on_disk.pop("on_disk"))
        for entry in copy.iterdir():
            if entry.suffix in (".thr", ".thl") or entry.name == "graph.thm":
                entry.unlink()
        made = components(copy)
        self.assertFalse(made.pop("on_disk"))
        self.assertGreater(on_disk["classes"][0]["components"], 0)
        self.assertEqual(on_disk["classes"][0]["at"], 0)
        for report in (on_disk, made):
            del report["seconds"]
        self.assertEqual(on_disk, made)

    def test_positions_outside_the_world_are_refused_by_each_command(self):
        for command in (["components", self.world, "--at", "5000,0,1"], ["query", self.world, "--at", "5000,0,8"],
                        ["path", self.world, "--from", "5000,0,8", "--to", "20,0,8"]):
            self.assert_refused(self.run_throng(*command), f"{command[2]} (5000.000", "lies outside the world, which reaches from")
        inside = self.run_throng("components", self.world, "--at", "14,300,8")
        self.assertEqual(inside.returncode, 0, inside.stderr)
        self.assertEqual(self.run_throng("query", self.world, "--at", "14,300,8").returncode, 1)
        self.assertEqual(self.run_throng("query", self.world, "--at", "-1,0,8").returncode, 0)  # There is one within 5 m.

    def test_a_query_reads_only_the_zones_around_it(self):
        done = self.run_throng("bake", "builtin:garage", "--cell", "0.2", "--zone", "12.8", "-o", "w.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        near = ("query", "w.throng", "--at", "14,0,8", "--radius", "2", "--json")
        before = self.run_throng(*near)
        self.assertEqual(before.returncode, 0, before.stderr)
        zones = {tuple(map(int, p.stem.split("_")[1:])): p for p in (self.path / "w.throng").glob("zone_*.thz")}
        self.assertGreater(len(zones), 6)
        # A circle of 2 m around (14, 8): of zones 12.8 m wide these two.
        for place, zone in zones.items():
            if place not in ((0, 0), (1, 0)):
                zone.write_bytes(b"?")
        after = self.run_throng(*near)
        self.assertEqual((after.returncode, after.stdout), (0, before.stdout), after.stderr)
        self.assert_refused(self.run_throng(*near[:-3], "--radius", "200"), "checksum")
        self.assert_refused(self.run_throng(*near, "--toward", "0,40"), "checksum")


if __name__ == "__main__":
    unittest.main(verbosity=2)
