# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""The program from outside: exit codes, one sentence, one JSON object, whole files or none.

python3 program_test.py build/release/throng"""
import base64
import json
import os
import pathlib
import re
import shutil
import signal
import struct
import sqlite3
import subprocess
import time
import unittest

from program_case import PROGRAM, ProgramCase

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def first_position(trajectories):
    """First position of the first avatar."""
    return trajectories.read_text().splitlines()[1].split(",")[3:6]


class Program(ProgramCase):
    def test_help_and_version_are_not_errors(self):
        for flag in ("--help", "--version"):
            done = self.run_throng(flag)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("throng", done.stdout)

    def test_bad_usage_is_one_sentence_and_two(self):
        self.assert_refused(self.run_throng(), "throng --help")
        self.assert_refused(self.run_throng("nosuch"), "throng --help")
        self.assert_refused(self.run_throng("bake", "builtin:cube"), "--output", "throng bake --help")
        self.assert_refused(self.run_throng("bake", "builtin:cube", "-o", "x", "--cell", "wide"), "--cell")
        self.assert_refused(self.run_throng("run", self.world, "--avatars", "-5"), "--avatars")
        self.assert_refused(self.run_throng("bake", "--json", "-o", "x.throng"), "no model")

    def test_a_bad_value_is_refused_with_the_type_that_help_shows(self):
        ends = ["path", self.world, "--from", "14,0,8", "--to", "20,0,8"]
        self.assert_refused(self.run_throng(*ends, "--tolerance", "-1"), "--tolerance: -1 is below 0;")
        self.assert_refused(self.run_throng(*ends, "--tolerance", "nan"), "--tolerance: nan is not a finite number;")
        self.assert_refused(self.run_throng(*ends, "--slope-cost", "1001"), "--slope-cost: 1001 is above 1000;")
        self.assert_refused(self.run_throng(*ends, "--block", "1,2,3,4,5"), "--block: wants X,Y,Z,X,Y,Z, and got 1,2,3,4,5;")
        self.assert_refused(self.run_throng(*ends, "--area-cost", "7=abc"), "--area-cost: wants KIND=COST, not 7=abc;")
        self.assert_refused(self.run_throng(*ends, "--from", "1,2,3"), "--from: wants X,Y,Z, once, and got 14,0,8,1,2,3;")
        self.assert_refused(self.run_throng("query", self.world, "--at", "1,2"), "--at: wants X,Y,Z, and got 1,2;")
        self.assert_refused(self.run_throng("bake", "builtin:cube", "-o", "x", "--cell", "wide"), "--cell: wants a number, not wide;")
        self.assert_refused(self.run_throng("bake", "builtin:cube", "-o", "x", "--scale", "0"), "--scale: 0 is not above 0;")
        self.assert_refused(self.run_throng("components", self.world, "--threads", "few"), "--threads: few is no number;")
        self.assert_refused(self.run_throng("components", self.world, "--limit", "-3"), "--limit: -3 is below 0;")

    def test_bad_input_is_one_sentence_and_two(self):
        self.assert_refused(self.run_throng("bake", "missing.obj", "-o", "x.throng", "--json"), "missing.obj")
        self.assert_refused(self.run_throng("bake", "builtin:nosuch", "-o", "x.throng"), "nosuch")
        self.assert_refused(self.run_throng("bake", "builtin:cube,size=wide", "-o", "x.throng"), "size=wide")
        self.assert_refused(self.run_throng("bake", "builtin:cube", "-o", "x.throng", "--cell", "0"), "cell")
        self.assert_refused(self.run_throng("info", self.path), str(self.path))
        (self.path / "no.patches.json").write_text('{"patches":[]}')
        self.assert_refused(self.run_throng("bake", "no.patches.json", "-o", "x.throng"), "no.patches.json", "throng-patches")
        (self.path / "no.patches.json").unlink()
        self.assert_refused(self.run_throng("run", self.world, "--class", "horse"), "horse", "adult")
        self.assertEqual(list(self.path.iterdir()), [])

    def test_values_that_are_no_finite_numbers_are_refused(self):
        ends = ["path", self.world, "--from", "14,0,8", "--to", "20,0,8"]
        self.assert_refused(self.run_throng(*ends, "--tolerance", "nan"), "--tolerance", "finite")
        self.assert_refused(self.run_throng(*ends, "--tolerance", "inf"), "--tolerance", "finite")
        self.assert_refused(self.run_throng(*ends, "--tolerance", "far"), "--tolerance", "no number")
        self.assert_refused(self.run_throng(*ends, "--slope-cost", "-NaN"), "--slope-cost", "finite")
        self.assert_refused(self.run_throng("query", self.world, "--at", "14,0,8", "--toward", "nan,0"), "--toward", "finite")
        self.assert_refused(self.run_throng("components", self.world, "--at", "nan,0,8"), "--at", "finite")
        self.assert_refused(self.run_throng("picture", self.world, "-o", "p.png", "--area", "nan,0,1,1"), "--area", "finite")
        self.assertEqual(list(self.path.iterdir()), [])

    def test_a_changed_bit_in_any_file_of_a_world_is_found(self):
        done = self.run_throng("bake", "builtin:cube", "--cell", "0.2", "--fly", "--nodes", "-o", "w.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        files = sorted(p for p in (self.path / "w.throng").rglob("*") if p.is_file())
        indexes = {"manifest.thm", "air.thm", "graph.thm", "index.thn", "index.thg"}
        self.assertEqual({p.name for p in files} & indexes, indexes)
        self.assertEqual(self.run_throng("info", "w.throng", "--check").returncode, 0)
        for path in files:
            content = path.read_bytes()
            for i in range(0, len(content), max(1, len(content) // 20)):
                path.write_bytes(content[:i] + bytes([content[i] ^ 1 << i % 8]) + content[i + 1:])
                self.assert_refused(self.run_throng("info", "w.throng", "--check"), path.name)
            path.write_bytes(content)
        self.assertEqual(self.run_throng("info", "w.throng", "--check").returncode, 0)

    def test_a_damaged_zone_is_named_by_each_command_that_reads_it(self):
        world = self.path / "w.throng"
        shutil.copytree(self.world, world)
        zone = next(iter(sorted(world.glob("zone_*.thz"))))
        content = zone.read_bytes()
        zone.write_bytes(content[:len(content) // 2] + b"?" + content[len(content) // 2 + 1:])
        ends = ["--from", "14,0,8", "--to", "20,0,8"]
        self.assert_refused(self.run_throng("path", "w.throng", *ends), zone.name)
        self.assert_refused(self.run_throng("path", "w.throng", *ends, "--block", "16,0,0,17,2,9"), zone.name)
        self.assert_refused(self.run_throng("picture", "w.throng", "-o", "p.png"), zone.name)
        self.assert_refused(self.run_throng("query", "w.throng", "--at", "14,0,8"), zone.name)

    def test_air_without_its_index_is_no_world_without_air(self):
        done = self.run_throng("bake", "builtin:cube", "--cell", "0.2", "--fly", "-o", "w.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        (self.path / "w.throng" / "air.thm").unlink()
        fly = ("--from", "1,1,1", "--to", "2,1,1", "--fly")
        for command in (["path", "w.throng", *fly, "--class", "flyer"], ["info", "w.throng", "--check"], ["info", "w.throng"]):
            self.assert_refused(self.run_throng(*command), "air.thm: is missing, though zone_0_0.tha", "bake")
        self.assert_refused(self.run_throng("path", self.world, "--from", "14,0,8", "--to", "20,0,8", "--fly"), "baked without air")

    def test_landscapes_are_written_curved_read_back_and_refused_when_damaged(self):
        hills = self.path / "hills.patches.json"
        self.assertEqual(self.run_throng("generate", "landscape", "--size", 64, "-o", hills).returncode, 0)
        baked = []
        for source in ("builtin:landscape,size=64", hills):
            done = self.run_throng("bake", source, "-o", "x.throng", "--cell", 0.5, "--json")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertGreater(json.loads(done.stdout)["patches"], 30)
            baked.append([(p.name, p.read_bytes()) for p in sorted((self.path / "x.throng").iterdir())])
        self.assertEqual(baked[0], baked[1])
        self.assert_refused(self.run_throng("generate", "cube", "-o", "cube.patches.json"), "no patches", ".glb")
        hills.write_text(hills.read_text().replace("[1,0]", "[1,1]", 1))
        self.assert_refused(self.run_throng("bake", hills, "-o", "y.throng"), "hills.patches.json", "edge")
        for name, content in (("a.zonel", b"\x03ZONE\x02"), ("a.bpt", b"2\n3 3\n1 2"), ("a.patches.json", b"{")):
            (self.path / name).write_bytes(content)
            self.assert_refused(self.run_throng("bake", name, "-o", "y.throng"), name)
        self.assertFalse((self.path / "y.throng").exists())

    def test_more_avatars_than_fit_are_refused_with_the_number_that_fits(self):
        done = self.run_throng("run", self.world, "--avatars", 10_000_000, "--steps", 1, "--wander")
        self.assert_refused(done, "fit")
        counts = [int(n) for n in re.findall(r"\d+", done.stderr)]
        fitting = [n for n in counts if 0 < n < 10_000_000]
        self.assertTrue(fitting, done.stderr)
        again = self.run_throng("run", self.world, "--avatars", max(fitting), "--steps", 1, "--wander")
        self.assertEqual(again.returncode, 0, again.stderr)

    def test_json_is_one_object_on_standard_output(self):
        for arguments in (("bake", "builtin:cube", "-o", "cube.throng", "--json"),
                          ("info", self.world, "--check", "--json"),
                          ("run", self.world, "--avatars", 50, "--steps", 5, "--json")):
            done = self.run_throng(*arguments)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIsInstance(json.loads(done.stdout), dict)

    def test_a_run_prints_its_time_by_parts_and_the_mean_of_all_steps_first(self):
        parts = ("open", "prepare", "plan", "sort", "steer", "commit", "settle", "obstacles", "events", "goals", "write", "check")
        for goals, names in ((("--wander",), ("open", "prepare", "sort", "move", "write", "check")), (("--goals", "random"), parts)):
            arguments = ("run", self.world, "--avatars", 50, "--steps", 30, *goals)
            report = json.loads(self.run_throng(*arguments, "--json").stdout)
            known = sum(report[f"seconds_{name}"] for name in (*names, "other"))
            self.assertAlmostEqual(known, report["seconds_wall"], delta=1e-6 + 1e-3 * report["seconds_wall"])
            self.assertAlmostEqual(report["ns_per_avatar_step_mean"], report["seconds_total"] * 1e9 / 50 / 30, delta=1)
            self.assertEqual(report["ns_per_avatar_step"], report["ns_per_avatar_step_median"])
            lines = self.run_throng(*arguments).stdout.splitlines()
            self.assertRegex(lines[0], r": [0-9.]+ ns an avatar a step \(mean; [0-9.]+ median\)$")
            self.assertRegex(lines[1], r"^time [0-9.]+ s: open [0-9.]+ s \([0-9]+ %\), .*, other [0-9.]+ s \([0-9]+ %\)$")

    def test_lengths_of_steps_that_cannot_be_walked_are_refused_with_a_sentence(self):
        for length in ("0", "-1", "1e-300", "1e-20", "1e-9", "1e9", "inf", "nan"):
            for goals in (("--wander",), ("--goals", "random")):
                done = self.run_throng("run", self.world, "--avatars", 5, "--steps", 2, "--dt", length, *goals)
                self.assertEqual(done.returncode, 2, (length, done.stderr))
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertEqual(self.run_throng("caacd", "--dt", length, "--avatars", 5).returncode, 2)

    def test_a_run_has_the_same_state_for_any_threads_and_another_for_another_seed(self):
        def state(**options):
            words = [word for key, value in options.items() for word in (f"--{key}", value)]
            report = json.loads(self.run_throng("run", self.world, "--avatars", 300, "--steps", 40, "--wander", "--json",
                                                *words).stdout)
            self.assertEqual((report["wall_entries"], report["overlaps"]), (0, 0))
            self.assertGreater(report["moved"], 0)
            return report["state_hash"]
        self.assertEqual(len({state(threads=threads) for threads in (1, 2, 3, 8)}), 1)
        self.assertNotEqual(state(seed=1), state(seed=2))

    def test_trajectories_have_a_line_an_avatar_a_step_with_four_decimals(self):
        done = self.run_throng("run", self.world, "--avatars", 20, "--steps", 10, "--wander", "--every", 5, "--trajectories",
                               "walk.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        head, *lines = (self.path / "walk.csv").read_text().splitlines()
        self.assertEqual(head, "step,id,class,x,y,z,radius")
        self.assertEqual(len(lines), 20 * 3)  # Steps 0, 5 and 10.
        for line in lines:
            self.assertRegex(line, r"^\d+,\d+,adult(,-?\d+\.\d{4}){4}$")
        self.assertEqual([entry.name for entry in self.path.iterdir()], ["walk.csv"])

    def test_a_recording_holds_what_trajectories_hold_in_every_format(self):
        self.assert_formats_hold_trajectories(self.world)

    def test_a_recording_in_a_national_grid_holds_the_millimetre_in_every_format(self):
        for name, east, north in (("utm", 678000, 5403500), ("south", -9999970, 9999970)):
            with self.subTest(name):
                corners = ((0, 0), (30, 0), (30, 30), (0, 30))
                lines = [f"v {east + x}.000 {north + y}.000 370.000" for x, y in corners] + ["f 1 2 3", "f 1 3 4"]
                (self.path / "utm.obj").write_text("\n".join(lines) + "\n")
                self.assertEqual(self.run_throng("bake", "utm.obj", "--up", "z", "-o", name).returncode, 0)
                self.assert_formats_hold_trajectories(name)
                said = json.loads(self.run_throng("replay", "walk.replay", "--json").stdout)
                self.assertEqual(said["origin"], [0 if abs(east) < 1e6 else east + 15, 0, -north - 15])
                done = self.run_throng("replay", "walk.replay", "--check")
                self.assertEqual(done.returncode, 0, done.stderr)
                at = json.loads(self.run_throng("replay", "walk.replay", "--at", 1, "--json").stdout)
                for avatar in at["avatars"]:
                    x, y, z = avatar["position"]
                    self.assertTrue(east < x < east + 30 and y == 370 and -north - 30 < z < -north, avatar)
                done = self.run_throng("report", "walk.replay", "-o", "out.html", "--line", f"{east + 15},{-north - 30},{east + 15},{-north}")
                self.assertEqual(done.returncode, 0, done.stderr)

    def assert_formats_hold_trajectories(self, world):
        done = self.run_throng("run", world, "--avatars", 30, "--steps", 12, "--wander", "--every", 3, "--dt", 0.2, "--trajectories",
                               "walk.csv", "--record", "walk.replay")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.run_throng("replay", "walk.replay", "--csv", "out.csv", "--txt", "out.txt", "--sqlite", "out.sqlite", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual((said["frames"], said["max_avatars"], said["positions"], said["complete"]), (5, 30, 150, True))
        self.assertEqual(said["settings"], {"avatars": 30, "class": "adult", "dt": 0.2, "speed": 0.0, "seed": 1})
        wrote = [line.split(",") for line in (self.path / "walk.csv").read_text().splitlines()]
        read = [line.split(",") for line in (self.path / "out.csv").read_text().splitlines()]
        self.assertEqual([line[:3] for line in wrote], [line[:3] for line in read])
        positions = {}
        for a, b in zip(wrote[1:], read[1:]):
            for k in range(3, 7):
                self.assertLess(abs(float(a[k]) - float(b[k])), 0.00056)
            positions[int(a[0]) // 3, int(a[1])] = tuple(float(v) for v in b[3:6])
        # As PedPy's load_trajectory_from_txt reads it.
        head, data = [], {}
        for line in (self.path / "out.txt").read_text().splitlines():
            if line.startswith("#"):
                head.append(line)
                continue
            number, frame, x, y, z = line.split()
            data[int(frame), int(number)] = (float(x), float(z), float(y))
        rates = [float(word) for line in head if "framerate" in line for word in line.split() if word[0].isdigit()]
        self.assertEqual(len(rates), 1)
        self.assertAlmostEqual(rates[0], 1 / 0.6)
        self.assertTrue(any("x/m" in line for line in head))
        self.assertEqual(data, positions)
        # As its load_trajectory_from_jupedsim_sqlite and load_walkable_area_from_jupedsim_sqlite read it.
        base = sqlite3.connect(self.path / "out.sqlite")
        self.addCleanup(base.close)
        rows = base.execute("select frame, id, pos_x as x, pos_y as y from trajectory_data").fetchall()
        self.assertEqual({row[:2]: row[2:] for row in rows}, {key: (x, z) for key, (x, _, z) in positions.items()})
        about = dict(base.execute("select key, value from metadata"))
        self.assertAlmostEqual(float(about["fps"]), 1 / 0.6)
        self.assertEqual(int(about["version"]), 2)
        (area,), = base.execute("select wkt from geometry").fetchall()
        self.assertRegex(area, r"^POLYGON \(\((-?\d+\.\d{3} -?\d+\.\d{3}(, |\)(, \()?))+\)$")
        self.assertEqual(base.execute("select count(*) from frame_data join geometry on geometry_hash = hash").fetchone(), (5,))
        for x, y in base.execute("select ori_x * ori_x + ori_y * ori_y, 1 from trajectory_data"):
            self.assertAlmostEqual(x, y, places=5)
        at = json.loads(self.run_throng("replay", "walk.replay", "--at", 1.3, "--json").stdout)
        self.assertEqual(at["step"], 6)
        for avatar in at["avatars"]:
            self.assertEqual(tuple(avatar["position"]), positions[2, avatar["id"]])

    def test_a_recording_of_a_crowd_with_goals_is_repeated_exactly_and_has_its_radii(self):
        done = self.run_throng("run", self.world, "--avatars", 40, "--steps", 25, "--goals", "random", "--radius", 0.2, "--every", 2,
                               "--record", "walk.replay", "--trajectories", "walk.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.run_throng("replay", "walk.replay", "--check", "--json", "--threads", 1)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["same"], 26)
        at = json.loads(self.run_throng("replay", "walk.replay", "--at", 2, "--json").stdout)
        for avatar in at["avatars"]:
            self.assertAlmostEqual(avatar["radius"], 0.2)
        self.assertTrue((self.path / "walk.csv").read_text().endswith(",0.2000\n"))

    def test_a_killed_run_leaves_a_recording_that_opens_and_is_repeated_exactly(self):
        for wait in (0.05, 0.2, 0.5):
            process = subprocess.Popen([PROGRAM, "run", self.world, "--avatars", "50", "--steps", "100000000", "--wander", "--record",
                                        "walk.replay"], cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            file = self.path / "walk.replay"
            deadline = time.monotonic() + 60
            while (not file.exists() or file.stat().st_size < 4000) and time.monotonic() < deadline:
                time.sleep(0.01)
            time.sleep(wait)
            process.kill()
            process.communicate()
            done = self.run_throng("replay", "walk.replay", "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            said = json.loads(done.stdout)
            self.assertFalse(said["complete"])
            self.assertGreater(said["frames"], 30)
            self.assertIn("frames are good", done.stderr)
            content = file.read_bytes()[:20000]
            file.write_bytes(content)
            check = self.run_throng("replay", "walk.replay", "--check")
            self.assertEqual(check.returncode, 0, check.stderr)
            self.assertIn("all the same", check.stdout)
            file.unlink()

    def test_a_crowd_with_goals_arrives_and_its_recording_is_repeated_exactly(self):
        done = self.run_throng("run", self.world, "--avatars", 40, "--steps", 60, "--goals", "random", "--record", "goals.replay", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual((said["wall_entries"], said["overlaps"]), (0, 0))
        self.assertGreater(said["progress"], 0.5)
        self.assertGreaterEqual(said["planned"], 40)
        again = self.run_throng("run", self.world, "--avatars", 40, "--steps", 60, "--threads", 1, "--json")
        self.assertEqual(json.loads(again.stdout)["state_hash"], said["state_hash"])
        check = self.run_throng("replay", "goals.replay", "--check")
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn("all the same", check.stdout)

    def test_any_model_steers_and_is_recorded(self):
        run = ("run", self.world, "--avatars", 30, "--steps", 30, "--goals", "random", "--json")
        hashes = set()
        for model in ("sampled", "caacd", "social-force"):
            done = self.run_throng(*run, "--model", model, "--record", "model.replay")
            self.assertEqual(done.returncode, 0, done.stderr)
            said = json.loads(done.stdout)
            self.assertEqual((said["wall_entries"], said["overlaps"], said["model"]), (0, 0, model))
            hashes.add(said["state_hash"])
            check = self.run_throng("replay", "model.replay", "--check", "--threads", 1)
            self.assertEqual(check.returncode, 0, check.stderr)
            self.assertIn("all the same", check.stdout)
        self.assertEqual(len(hashes), 3)
        self.assert_refused(self.run_throng(*run, "--model", "orca"), "sampled, caacd or social-force")
        for option in (("--model", "caacd"), ("--goals", "random"), ("--near", 5), ("--set", "2/1/1"), ("--labels",)):
            self.assert_refused(self.run_throng("run", self.world, "--wander", *option), option[0], "--wander")

    def test_flyers_take_off_and_land_and_their_recording_is_repeated(self):
        done = self.run_throng("bake", "builtin:garage,levels=2", "-o", "air.throng", "--cell", 0.2, "--fly")
        self.assertEqual(done.returncode, 0, done.stderr)
        run = ("run", "air.throng", "--class", "flyer", "--avatars", 40, "--steps", 200, "--goals", "random", "--json")
        done = self.run_throng(*run, "--record", "air.replay", "--trajectories", "air.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual((said["wall_entries"], said["overlaps"], said["checks"]), (0, 0, 10))
        self.assertGreater(said["arrived"], 10)
        self.assertGreater(said["flying"], 0)
        again = self.run_throng(*run, "--threads", 1)
        self.assertEqual(json.loads(again.stdout)["state_hash"], said["state_hash"])
        check = self.run_throng("replay", "air.replay", "--check")
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn("all the same", check.stdout)
        heights = {float(line.split(",")[4]) for line in (self.path / "air.csv").read_text().splitlines()[1:]}
        self.assertGreater(len(heights), 100)
        self.assertIn(5.8, heights)  # One landed on the upper floor.
        (self.path / "goals.csv").write_text("{},{},{}\n".format(*first_position(self.path / "air.csv")))
        done = self.run_throng("run", "air.throng", "--class", "flyer", "--avatars", 3, "--steps", 40, "--goals", "goals.csv", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_climbers_move_over_nodes_among_others_and_their_recording_is_repeated(self):
        (self.path / "classes.toml").write_text(
            '[[class]]\nname = "adult"\n[[class]]\nname = "climber"\nclimb_slope = 180\n')
        done = self.run_throng("bake", "builtin:landscape,size=64", "-o", "hills.throng", "--cell", 0.5,
                               "--node-size", 1.5, "--classes", "classes.toml")
        self.assertEqual(done.returncode, 0, done.stderr)
        run = ("run", "hills.throng", "--class", "climber", "--avatars", 30, "--also", "adult:20", "--steps", 150,
               "--goals", "random", "--near", 15, "--json")
        done = self.run_throng(*run, "--record", "hills.replay", "--trajectories", "hills.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual((said["wall_entries"], said["overlaps"], said["climbing"], said["avatars"]), (0, 0, 30, 50))
        self.assertGreater(said["arrived"], 5)
        again = self.run_throng(*run, "--threads", 1)
        self.assertEqual(json.loads(again.stdout)["state_hash"], said["state_hash"])
        # The table has the inclination of climbers; adults stand upright.
        rows = (self.path / "hills.csv").read_text().splitlines()
        self.assertEqual(rows[0], "step,id,class,x,y,z,radius,up_x,up_y,up_z")
        ups = [(float(row[7]), float(row[8]), float(row[9]), row[2]) for row in (line.split(",") for line in rows[1:])]
        self.assertTrue(all(abs(x * x + y * y + z * z - 1) < 1e-3 for x, y, z, _ in ups))
        self.assertTrue(all(name == "climber" for _, y, _, name in ups if y < 1))
        self.assertLess(min(y for _, y, _, _ in ups), 0.9)
        self.run_throng("replay", "hills.replay", "--csv", "again.csv")
        again = (self.path / "again.csv").read_text().splitlines()
        self.assertEqual(len(again), len(rows))
        for line, (x, y, z, _) in zip(again[1:], ups):
            for a, b in zip(map(float, line.split(",")[7:]), (x, y, z)):
                self.assertAlmostEqual(a, b, delta=0.0012)
        check = self.run_throng("replay", "hills.replay", "--check")
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn("all the same", check.stdout)
        for group in ("adult", "adult:0", "adult:x", ":3"):
            self.assert_refused(self.run_throng(*run, "--also", group), "CLASS:N")
        self.assert_refused(self.run_throng(*run, "--also", "horse:3"), "horse")
        index = self.path / "hills.throng" / "nodes" / "index.thn"
        whole = index.read_bytes()
        index.write_bytes(whole[: len(whole) // 2])
        self.assert_refused(self.run_throng(*run), "index.thn")
        walkers = self.run_throng("run", "hills.throng", "--class", "adult", "--avatars", 20, "--steps", 5)
        self.assertEqual(walkers.returncode, 0, walkers.stderr)  # Walkers read no nodes.

    def test_goals_of_a_file_are_walked_to_and_bad_ones_named(self):
        self.run_throng("run", self.world, "--avatars", 1, "--steps", 1, "--trajectories", "at.csv")
        at = (self.path / "at.csv").read_text().splitlines()[-1].split(",")[3:6]
        (self.path / "goals.csv").write_text("# the only one\n{},{},{}\n".format(*at))
        done = self.run_throng("run", self.world, "--avatars", 3, "--steps", 20, "--goals", "goals.csv", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["goals"], "goals.csv")
        for text, words in (("1,2\n", "goals.csv:1"), ("1e6,0,0\n", "within 2 m"), ("", "no goals")):
            (self.path / "goals.csv").write_text(text)
            self.assert_refused(self.run_throng("run", self.world, "--goals", "goals.csv"), words)
        self.assert_refused(self.run_throng("run", self.world, "--goals", "missing.csv"), "missing.csv")

    def scenario(self):
        """The example of the documentation."""
        text = (ROOT / "docs" / "scenarios.md").read_text()
        file = self.path / "hall.toml"
        file.write_text(re.search(r"^```toml\n(.*?)^```$", text, re.MULTILINE | re.DOTALL).group(1))
        return file

    def test_the_scenario_of_the_documentation_runs_and_is_repeated_exactly(self):
        file = self.scenario()
        done = self.run_throng("run", file, "--json", "--record", "hall.replay", "--trips", "trips.csv",
                               "--check-every", 1)
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(done.stdout)
        self.assertEqual([result[k] for k in ("wall_entries", "overlaps", "obstacle_entries", "goal_unreachable")], [0] * 4)
        self.assertEqual(result["left"], result["entered"])
        self.assertGreater(result["entered"], 150)
        self.assertEqual(sum(e["left"] for e in result["exits"].values()), result["left"])
        lines = (self.path / "trips.csv").read_text().splitlines()
        self.assertEqual(lines[0], "person,source,profile,journey,speed,entered,started,left,exit")
        self.assertEqual(len(lines), result["entered"] + 1)
        for threads in (1, 2):
            again = self.run_throng("replay", "hall.replay", "--check", "--threads", threads)
            self.assertEqual(again.returncode, 0, again.stderr + again.stdout)
            self.assertIn("all the same", again.stdout)
        other = json.loads(self.run_throng("run", file, "--seed", 2, "--steps", 50, "--json").stdout)
        self.assertNotEqual(other["state_hash"], result["state_hash"])
        done = self.run_throng("run", file, "--model", "social-force", "--steps", 50, "--json", "--record", "force.replay")
        self.assertEqual(json.loads(done.stdout)["model"], "social-force", done.stderr)
        again = self.run_throng("replay", "force.replay", "--check")
        self.assertIn("all the same", again.stdout)

    def test_the_schema_of_scenarios_knows_the_keys_that_the_program_knows(self):
        schema = json.loads((ROOT / "docs" / "scenario.schema.json").read_text())["properties"]
        tables = {name: part["items"]["properties"] for name, part in schema.items() if part.get("type") == "array"}
        tables.update({name: schema[name]["properties"] for name in ("plane", "builtin")})
        tables["stages"] = tables["journey"]["stages"]["items"]["properties"]
        text = self.scenario().read_text()
        text += '\n[[link]]\nname = "lift"\nfrom = "hall"\nto = "hall"\nseconds = 1\n[[density]]\nname = "map"\nbox = [13, 3, 20, 9]\npaint = [{ area = "hall", weight = 1 }]\n'
        text += '[[class]]\nname = "adult"\n[[obstacle]]\nname = "crate"\nbox = [15, 9, 16, 10]\n'
        text += '[[attractor]]\nname = "crowd puller"\ndensity = "map"\nobstacle = "crate"\n'
        wrong = {name: text.replace(f"[[{name}]]", f"[[{name}]]\nnonsense = 1", 1) for name in tables}
        wrong["plane"] = text.replace("[plane]", "[plane]\nnonsense = 1")
        wrong["builtin"] = '[builtin]\nname = "cube"\nnonsense = 1\n'
        wrong["stages"] = text.replace("{ go =", "{ nonsense = 1, go =", 1)
        wrong["top"], tables["top"] = "nonsense = 1\n" + text, schema
        for name, body in wrong.items():
            (self.path / "wrong.toml").write_text(body)
            done = self.run_throng("run", "wrong.toml")
            self.assert_refused(done, "wrong.toml:", "unknown key 'nonsense'")
            known = done.stderr.strip().split("known are ")[1].split(", ")
            self.assertEqual(sorted(known), sorted(tables[name]), name)

    def test_trials_of_the_standards_are_found_and_give_the_same_for_any_threads(self):
        listed = json.loads(self.run_throng("validate", "--list", "--json").stdout)["tests"]
        names = [test["test"] for test in listed]
        self.assertEqual([n for n in names if n.startswith("rimea.")], [f"rimea.{k}" for k in range(1, 17)])
        self.assertEqual(sum(n.startswith("nist.") for n in names), 17)
        self.assertEqual(len(set(names)), len(names))
        self.assertEqual({t["test"] for t in listed if t.get("in_work")}, {f"motion.{n}" for n in ("haste", "flow", "narrow", "counterflow", "mazes", "jams")})
        self.assertEqual(sum(n.startswith("motion.") for n in names), 12)
        for test in listed:
            self.assertTrue(test["title"] and test["source"] and (test.get("lacks") or test["method"]), test)
        cheap = ("rimea.1", "rimea.2", "rimea.3", "rimea.5", "rimea.6", "rimea.10", "nist.2.1", "nist.2.2", "nist.2.3",
                 "nist.2.4", "nist.2.5", "nist.2.9", "nist.4.1")
        runs = []
        for threads in (1, 2, 4):
            done = self.run_throng("validate", *cheap, "--threads", threads, "--json")
            self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
            runs.append(json.loads(done.stdout)["tests"])
            for test in runs[-1]:
                test.pop("seconds", None)
        self.assertEqual(runs[0], runs[1])
        self.assertEqual(runs[0], runs[2])
        smoke = runs[0][cheap.index("nist.2.5")]
        self.assertNotIn("passed", smoke)
        self.assertIn("smoke", smoke["lacks"])

    def test_recordings_are_compared_and_damaged_ones_are_refused(self):
        self.assert_refused(self.run_throng("validate", "walkers"), "walkers", "FOLDER")
        self.assert_refused(self.run_throng("validate", "walkers", self.path), str(self.path), "obsmat.txt")
        self.assert_refused(self.run_throng("validate", "laboratory", "nowhere"), "nowhere", "uo-050-180-180.txt")
        (self.path / "obsmat.txt").write_text("1 1 0 0 0 0 0 0\n11 1 0.4 0 zero 0 0 0\n")
        self.assert_refused(self.run_throng("validate", "walkers", self.path), "obsmat.txt:2:")
        (self.path / "obsmat.txt").write_text("".join(f"{10 * k + 1} {n} {0.5 * k} 0 {3 * n} 0 0 0\n" for k in range(20) for n in (1, 2)))
        done = self.run_throng("validate", "walkers", self.path, "rimea.1", "--json", "-o", "charts")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([t["test"] for t in json.loads(done.stdout)["tests"]], ["walkers", "rimea.1"])
        self.assertEqual(len(list((self.path / "charts").glob("walkers_*.png"))), 1)

    def test_a_trial_of_a_user_is_judged_and_a_bad_one_is_refused(self):
        text = (ROOT / "trials" / "rimea" / "01_corridor.toml").read_text()
        (self.path / "mine.toml").write_text(text.replace("high = 34", "high = 27"))
        self.assertEqual(self.run_throng("run", "mine.toml").returncode, 0)
        done = self.run_throng("validate", "mine.toml", "--json")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertFalse(json.loads(done.stdout)["tests"][0]["measures"][0]["passed"])
        (self.path / "bad.toml").write_text(text.replace('of = "time"', 'of = "weather"'))
        self.assert_refused(self.run_throng("validate", "bad.toml"), "bad.toml:", "of must be one of: time")
        self.assert_refused(self.run_throng("validate", "none.toml"), "none.toml")
        self.assert_refused(self.run_throng("validate", "rimea.99"), "rimea.99", "rimea.1,")
        wrong = text.replace("[[measure]]", "[[measure]]\nnonsense = 1")
        (self.path / "wrong.toml").write_text(wrong)
        done = self.run_throng("validate", "wrong.toml")
        self.assert_refused(done, "unknown key 'nonsense'")
        known = done.stderr.strip().split("known are ")[1].split(", ")
        schema = json.loads((ROOT / "docs" / "scenario.schema.json").read_text())
        self.assertEqual(sorted(known), sorted(schema["definitions"]["measures"]["items"]["properties"]))

    def test_options_of_worlds_are_refused_for_scenarios_and_vice_versa(self):
        file = self.scenario()
        self.assert_refused(self.run_throng("run", file, "--avatars", 3), "--avatars", "hall.toml")
        self.assert_refused(self.run_throng("run", file, "--wander"), "--wander", "hall.toml")
        self.assert_refused(self.run_throng("run", self.world, "--trips", "v.csv"), "--trips")
        self.assert_refused(self.run_throng("run", "none.toml"), "none.toml", "cannot be read")
        self.assertFalse((self.path / "v.csv").exists())

    def test_a_report_is_one_page_that_holds_its_pictures(self):
        self.run_throng("run", self.world, "--avatars", 40, "--steps", 60, "--wander", "--record", "walk.replay")
        done = self.run_throng("report", "walk.replay", "-o", "report.html", "--line", "20,0,20,30", "--line", "1,1,9,1,0", "--png",
                               "pic", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual((said["frames"], said["positions"], said["left"], len(said["lines"])), (61, 61 * 40, 0, 2))
        self.assertGreater(said["mean_speed"], 0.5)
        page = (self.path / "report.html").read_text(encoding="ascii")
        pictures = sorted(entry for entry in self.path.iterdir() if entry.suffix == ".png")
        self.assertEqual(len(pictures), 4 + 2 * said["storeys"])
        held = {base64.b64decode(data) for data in re.findall(r'src="data:image/png;base64,([^"]*)"', page)}
        self.assertEqual(held, {picture.read_bytes() for picture in pictures})
        self.assertNotRegex(page, r"(src|href)=\"(?!data:)")
        self.assertEqual(page.count("<tr>"), page.count("</tr>"))
        for word in ("wanderers", "seed", "adult", "complete", "mean speed"):
            self.assertIn(word, page)
        again = self.run_throng("report", "walk.replay", "-o", "again.html", "--line", "20,0,20,30", "--line", "1,1,9,1,0")
        self.assertEqual(again.returncode, 0)
        self.assertEqual((self.path / "again.html").read_text(), page)
        for words, *named in ((("--line", "1,2,3"), "--line 1,2,3", "X0,Z0,X1,Z1"), (("--line", "1,2,3,4,"), "--line"),
                              (("--line", "1,2,1,2"), "line 1", "two different ends"), (("--cell", "0"), "cell"),
                              (("--cell", "0.002"), "larger cells"), (("--png", "no/pic"), "no/pic")):
            self.assert_refused(self.run_throng("report", "walk.replay", "-o", "bad.html", *words), *named)
        self.assert_refused(self.run_throng("report", "missing.replay", "-o", "bad.html"), "missing.replay")
        self.assert_refused(self.run_throng("report", "walk.replay", "-o", "no/bad.html"), "no/bad.html")
        self.assertFalse((self.path / "bad.html").exists())

    def test_what_is_no_recording_is_refused_in_one_sentence(self):
        self.assert_refused(self.run_throng("replay", "missing.replay"), "missing.replay")
        (self.path / "text.replay").write_text("step,id\n")
        self.assert_refused(self.run_throng("replay", "text.replay"), "text.replay", "not a recording")
        self.run_throng("run", self.world, "--avatars", 5, "--steps", 5, "--record", "walk.replay")
        self.assert_refused(self.run_throng("replay", "walk.replay", "--csv", "no/walk.csv"), "no/walk.csv")
        self.assert_refused(self.run_throng("replay", "walk.replay", "--sqlite", "no/walk.sqlite"), "no/walk.sqlite")
        self.assert_refused(self.run_throng("replay", "walk.replay", "--heights", 3, 1, "--csv", "x.csv"), "--heights")
        self.assert_refused(self.run_throng("replay", "walk.replay", "--check", "--world", "none.throng"), "none.throng", "--world")
        content = bytearray((self.path / "walk.replay").read_bytes())
        content[70] ^= 1
        (self.path / "walk.replay").write_bytes(content)
        self.assert_refused(self.run_throng("replay", "walk.replay"), "walk.replay", "corrupt")
        self.assert_refused(self.run_throng("run", self.world, "--record", "no/walk.replay"), "no/walk.replay")
        self.assertEqual(sorted(entry.name for entry in self.path.iterdir()), ["text.replay", "walk.replay"])

    def test_a_changed_byte_of_a_world_is_found_and_its_file_named(self):
        for kind in (".thz", ".thr", ".thl", "graph.thm"):
            copy = self.path / "copy.throng"
            subprocess.run(["cp", "-r", self.world, copy], check=True)
            zone = max((entry for entry in copy.iterdir() if entry.name.endswith(kind)),
                       key=lambda entry: entry.stat().st_size)
            content = bytearray(zone.read_bytes())
            content[len(content) // 2] ^= 0x10
            zone.chmod(0o644)
            zone.write_bytes(content)
            self.assert_refused(self.run_throng("info", copy, "--check"), zone.name)
            if kind != ".thl":  # Only a bake reads the links.
                at = ("components", copy, "--at", "14,0,8")
                self.assert_refused(self.run_throng(*at), zone.name, "bake the world again")
            shutil.rmtree(copy)

    def test_a_source_of_another_size_or_axis_than_the_world_is_noted(self):
        done = self.run_throng("generate", "garage", "--levels", 2, "-o", "garage.glb")
        self.assertEqual(done.returncode, 0, done.stderr)
        for options, is_elsewhere in (((), False), (("--scale", 0.1), True), (("--up", "z"), True)):
            done = self.run_throng("verify", self.world, "--source", "garage.glb", "--samples", 10, "--class", "adult", *options)
            self.assertIn(done.returncode, (0, 1), done.stderr)
            self.assertEqual("does not lie where the world does" in done.stderr, is_elsewhere, done.stderr)

    def write_character(self, name, bones, clip=True):
        """A triangle that follows `bones` joints in a row, as a glTF file of text."""
        weights = [struct.pack("<4H", *(min(4 * vertex + k, bones - 1) for k in range(4))) for vertex in range(3)]
        parts = [struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 2, 0), struct.pack("<9f", *([0, 0, 1] * 3)), b"".join(weights),
                 struct.pack("<12f", *([0.25] * 12)), struct.pack("<2f", 0, 1), struct.pack("<8f", *([0, 0, 0, 1] * 2)),
                 b"".join(struct.pack("<16f", *(1 if i % 5 == 0 else i == 12 and -float(joint) for i in range(16))) for joint in range(bones))]
        kinds = [("VEC3", 5126, 3), ("VEC3", 5126, 3), ("VEC4", 5123, 3), ("VEC4", 5126, 3), ("SCALAR", 5126, 2), ("VEC4", 5126, 2), ("MAT4", 5126, bones)]
        views, accessors, at = [], [], 0
        for part, (kind, component, count) in zip(parts, kinds):
            views.append({"buffer": 0, "byteOffset": at, "byteLength": len(part)})
            accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": count, "type": kind})
            at += len(part)
        accessors[0].update(min=[0, 0, 0], max=[1, 2, 0])
        data = base64.b64encode(b"".join(parts)).decode()
        document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
                    "nodes": [{"mesh": 0, "skin": 0}] + [{"name": f"joint{i}", **({"children": [i + 2]} if i + 1 < bones else {})} for i in range(bones)],
                    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}}]}],
                    "skins": [{"joints": list(range(1, bones + 1)), "inverseBindMatrices": 6}],
                    "buffers": [{"byteLength": at, "uri": "data:application/octet-stream;base64," + data}], "bufferViews": views, "accessors": accessors}
        if clip:
            document["animations"] = [{"name": "Walk", "samplers": [{"input": 4, "output": 5}],
                                       "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}]
        (self.path / name).write_text(json.dumps(document))

    def test_an_atlas_is_the_same_for_any_threads_and_lists_its_formats(self):
        small = ("--frames", "4", "--directions", "4", "--elevations", "2", "--pixels", "16")
        done = self.run_throng("atlas", "-o", "one.atlas", *small, "--threads", "1", "--images", "views", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads(done.stdout)
        self.assertEqual((report["directions"], report["views"], report["frames"]), (8, 32, 4))
        self.assertEqual([row["format"] for row in report["formats"]], ["rgba8", "rgb5a1", "bc1", "bc3", "etc2a1", "etc2"])
        self.assertEqual(report["formats"][1]["sheet_bytes"], 32 * 16 * 16 * 2)
        self.assertGreater(report["clips"][0]["stride"], 1)
        self.assertEqual(self.run_throng("atlas", "-o", "two.atlas", *small, "--threads", "2").returncode, 0)
        self.assertEqual((self.path / "one.atlas").read_bytes(), (self.path / "two.atlas").read_bytes())
        done = self.run_throng("atlas", "-o", "phone.atlas", *small, "--format", "ETC2", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["format"], "etc2")
        self.assertEqual(len(list((self.path / "views").glob("*.png"))), 4)
        self.write_character("three.gltf", 3)
        done = self.run_throng("atlas", "--clip", "Walk", "--clip", "walk", "three.gltf", "-o", "three.atlas", *small, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads(done.stdout)
        self.assertEqual((report["bones"], len(report["clips"])), (3, 2))

    def test_characters_that_cannot_be_drawn_are_refused_in_one_sentence(self):
        self.write_character("many.gltf", 300)
        self.write_character("still.gltf", 3, clip=False)
        self.write_character("three.gltf", 3)
        box = pathlib.Path(__file__).parent.parent / "data/box.glb"
        self.assert_refused(self.run_throng("atlas", "many.gltf", "-o", "x.atlas"), "many.gltf", "300 bones", "256")
        self.assert_refused(self.run_throng("atlas", "still.gltf", "-o", "x.atlas"), "still.gltf", "no clip")
        self.assert_refused(self.run_throng("atlas", "three.gltf", "--clip", "Swim", "-o", "x.atlas"), "three.gltf", "Swim", "Walk")
        self.assert_refused(self.run_throng("atlas", box, "-o", "x.atlas"), "box.glb", "skeleton")
        self.assert_refused(self.run_throng("atlas", "missing.glb", "-o", "x.atlas"), "missing.glb")
        self.assert_refused(self.run_throng("atlas", "-o", "x.atlas", "--pixels", "1"), "pixels 1", "8 to 256")
        self.assert_refused(self.run_throng("atlas", "-o", "x.atlas", "--frames", "5"), "frames 5", "even")
        self.assert_refused(self.run_throng("atlas", "-o", "x.atlas", "--format", "etc3"), "etc3", "bc1,bc3,etc2a1,etc2}")
        self.assert_refused(self.run_throng("atlas", "-o", "x.atlas", "--format", "gif"), "--format")
        self.assert_refused(self.run_throng("atlas", "-o", "nowhere/x.atlas", "--pixels", "8"), "nowhere/x.atlas")
        (self.path / "cut.gltf").write_text((self.path / "three.gltf").read_text()[:400])
        self.assert_refused(self.run_throng("atlas", "cut.gltf", "-o", "x.atlas"), "cut.gltf")
        self.assertEqual(list(self.path.glob("*.atlas*")), [])

    def test_gl_a_view_from_an_eye_is_drawn_without_a_window(self):
        done = self.run_throng("picture", self.world, "--crowd", "40", "--camera", "30,12,40,20,2,20", "--width", "320",
                               "-o", "seen.png", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads(done.stdout)
        self.assertEqual((report["width"], report["height"], report["avatars"]), (320, 180, 40))
        self.assertGreater(report["drawn"], 4)  # The others are hidden by the deck above them.
        self.assertEqual((self.path / "seen.png").read_bytes()[:4], b"\x89PNG")
        done = self.run_throng("run", self.world, "--avatars", "30", "--steps", "20", "--trajectories", "walk.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.run_throng("atlas", "-o", "a.atlas", "--frames", "4", "--pixels", "16").returncode, 0)
        done = self.run_throng("picture", self.world, "--avatars", "walk.csv", "--atlas", "a.atlas", "--source", "builtin:garage,levels=2",
                               "--camera", "30,12,40,20,2,20", "--width", "320", "--height", "240", "-o", "walk.png", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["avatars"], 30)

    def test_gl_a_national_grid_is_drawn_pixel_by_pixel_as_the_coordinate_origin(self):
        pictures = []
        for x, y, z in ((0, 0, 0), (678000, 370, -5403500), (-10000000, 0, 10000000)):
            corners = ((0, 0, 0), (30, 0, 0), (30, 0, -30), (0, 0, -30), (10, 0, -5), (10, 3, -5), (20, 3, -25), (20, 0, -25))
            lines = [f"v {x + a} {y + b} {z + c}" for a, b, c in corners] + ["f 1 2 3 4", "f 5 6 7 8"]
            (self.path / "hall.obj").write_text("\n".join(lines) + "\n")
            self.assertEqual(self.run_throng("bake", "hall.obj", "-o", "hall", "--cell", 0.125, "--rebuild").returncode, 0)
            run = self.run_throng("run", "hall", "--avatars", 30, "--steps", 20, "--record", "hall.replay", "--trajectories", "hall.csv")
            self.assertEqual(run.returncode, 0, run.stderr)
            camera = f"{x + 40},{y + 14},{z + 20},{x + 15},{y},{z - 15}"
            look = ("--source", "hall.obj", "--camera", camera, "--width", 320, "--height", 200)
            drawn = self.run_throng("picture", "hall", "--avatars", "hall.csv", *look, "-o", "seen.png")
            self.assertEqual(drawn.returncode, 0, drawn.stderr)
            viewed = self.run_throng("view", "hall.replay", *look, "--forget", "--after", 1, "--overlay", "Clearance", "--picture", "view.png")
            self.assertEqual(viewed.returncode, 0, viewed.stderr)
            pictures.append([(self.path / name).read_bytes() for name in ("seen.png", "view.png")])
        for picture in pictures[1:]:
            self.assertEqual(picture, pictures[0])

    def test_gl_pictures_that_cannot_be_drawn_are_refused_in_one_sentence(self):
        camera = ("--camera", "30,12,40,20,2,20", "-o", "x.png")
        self.assert_refused(self.run_throng("picture", self.world, "--crowd", "5", "-o", "x.png"), "--camera")
        self.assert_refused(self.run_throng("picture", self.world, "--camera", "1,2,3", "-o", "x.png"), "--camera")
        self.assert_refused(self.run_throng("picture", self.world, "--camera", "1,2,3,1,2,3", "-o", "x.png"), "eye and target")
        self.assert_refused(self.run_throng("picture", self.world, *camera, "--atlas", "missing.atlas"), "missing.atlas")
        (self.path / "bad.atlas").write_text("not an atlas")
        self.assert_refused(self.run_throng("picture", self.world, *camera, "--atlas", "bad.atlas"), "bad.atlas", "throng atlas")
        self.assert_refused(self.run_throng("picture", self.world, *camera, "--width", "9000"), "8192")
        nothing = dict(os.environ, __EGL_VENDOR_LIBRARY_FILENAMES=str(self.path / "none.json"))
        done = subprocess.run([PROGRAM, "picture", self.world, *camera], cwd=self.path, capture_output=True, text=True, check=False, env=nothing)
        self.assert_refused(done, "EGL", "install")
        self.assertFalse((self.path / "x.png").exists())
        (self.path / "walk.toml").write_text("builtin = { name = \"cube\" }\nseconds = 1\n")
        for option in ("--only-seen", "--coarse-far"):
            done = self.run_throng("film", "walk.toml", option, "--camera", "30,12,40,20,2,20", "-o", "x.mp4")
            self.assert_refused(done, "walk.toml", option)

    def test_interrupting_a_bake_leaves_nothing_half_written(self):
        process = subprocess.Popen([PROGRAM, "bake", "builtin:city,size=1500", "-o", "city.throng", "--threads", "1"],
                                   cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while not any(self.path.iterdir()) and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.02)
        self.assertIsNone(process.poll(), "the bake was over before it could be interrupted")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, err)
        self.assertEqual(out, "")
        self.assertEqual(list(self.path.iterdir()), [])

    def test_of_two_bakes_into_one_folder_the_second_is_refused(self):
        command = [PROGRAM, "bake", "builtin:city,size=700", "-o", "city.throng", "--cell", "0.2", "--threads", "1", "--nodes", "--json"]
        with subprocess.Popen(command, cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as first:
            refused = {"city.throng.part": 0, "city.throng": 0}  # While the ground is made, and the nodes.
            while first.poll() is None:
                there = {file.name for file in self.path.iterdir()}
                if there and refused[max(there, key=len)] == 0:
                    second = self.run_throng("bake", "builtin:stairs", "-o", "city.throng")
                    if first.poll() is not None:
                        break
                    self.assert_refused(second, "city.throng: another bake is writing it", "wait", "another folder")
                    refused[max(there, key=len)] += 1
                time.sleep(0.005)
            out, err = first.communicate()
        self.assertEqual(first.returncode, 0, err)
        self.assertGreater(json.loads(out)["nodes"], 0)
        self.assertGreater(refused["city.throng.part"], 0)
        self.assertGreater(refused["city.throng"], 0)
        self.assertEqual([file.name for file in self.path.iterdir()], ["city.throng"])
        self.assertEqual(self.run_throng("info", "city.throng", "--check").returncode, 0)
        # A killed bake holds no lock.
        with subprocess.Popen(command[:-2] + ["--rebuild"], cwd=self.path, stderr=subprocess.DEVNULL) as killed:
            while not (self.path / "city.throng.part").exists():
                time.sleep(0.005)
            killed.kill()
        done = self.run_throng("bake", "builtin:stairs", "-o", "city.throng")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_interrupting_a_run_leaves_no_trajectories(self):
        process = subprocess.Popen([PROGRAM, "run", self.world, "--avatars", "100", "--steps", "100000000",
                                    "--trajectories", "walk.csv", "--every", "100000"],
                                   cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while not any(self.path.iterdir()) and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(list(self.path.iterdir()), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
