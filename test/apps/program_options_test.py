# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Options that a command does not obey for what it is given, folders of pictures, and crowds beyond all bounds.

python3 program_options_test.py build/release/throng"""
import json
import os
import struct
import subprocess
import unittest
import zlib

from program_case import PROGRAM, ProgramCase

HALL = """seconds = 3
[plane]
floor = [[0, 0], [12, 0], [12, 8], [0, 8]]
[[area]]
name = "out"
box = [10, 1, 11, 7]
[[density]]
name = "map"
box = [0, 0, 8, 8]
image = "map.png"
[[journey]]
name = "walk"
stages = [{ leave = "out" }]
[[source]]
name = "start"
density = "map"
journey = "walk"
count = 8
"""


def grey_png(pixels):
    """A square picture of bytes, white where there are avatars."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    side = len(pixels)
    rows = b"".join(b"\0" + bytes(row) for row in pixels)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class ProgramOptions(ProgramCase):
    def write_hall(self):
        (self.path / "hall.toml").write_text(HALL)
        (self.path / "map.png").write_bytes(grey_png([[255, 0], [255, 255]]))

    def test_more_avatars_than_any_world_holds_are_refused_without_memory_for_them(self):
        huge = 2 ** 32 - 1
        self.assertEqual(self.run_throng("slices", "builtin:cube", "--cell", 0.5, "-o", "cube.slices").returncode, 0)
        for command in (("run", self.world, "--avatars", 5, "--also", f"adult:{huge - 5}"), ("run", self.world, "--avatars", huge),
                        ("run", self.world, "--wander", "--avatars", huge),
                        ("run", self.world, "--wander", "--avatars", 5, "--also", f"child:{huge - 5}"),
                        ("run", "cube.slices", "--wander", "--avatars", huge)):
            with self.subTest(command=command):
                with subprocess.Popen([PROGRAM, *map(str, command)], cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                      text=True) as process:
                    err = process.stderr.read()
                    _, status, usage = os.wait4(process.pid, 0)
                    process.returncode = os.waitstatus_to_exitcode(status)
                self.assertEqual(process.returncode, 2, err)
                self.assertRegex(err, r"^throng: [a-z]+: [0-9]+ avatars .*were asked for; ask for fewer or [^\n]*\n$")
                self.assertLess(usage.ru_maxrss, 1 << 20)  # [kB]
        self.assert_refused(self.run_throng("picture", self.world, "--camera", "30,12,40,20,2,20", "--crowd", huge, "-o", "a.png"),
                            "--crowd: 4294967295 is above 1000000")

    def test_options_of_worlds_are_refused_for_scenarios_with_a_key_that_exists(self):
        self.write_hall()
        for words, *named in ((("--avatars", 3), "count of a [[source]]"), (("--dt", 0.2), "hall.toml write dt"), (("--speed", 1), "speed of a [[profile]]"),
                              (("--class", "adult"), "class of a [[profile]]"), (("--radius", 0.2), "radius of a [[profile]]"),
                              (("--labels",), 'paths = "labels"'), (("--search-memory", 9), "write search_memory"),
                              (("--goals", "random"), "stages of a [[journey]]"), (("--also", "adult:3"), "another [[profile]]"),
                              (("--order", "state"), "no scenario can have it"), (("--set", "2/1/1"), "no scenario can have it"),
                              (("--wander",), "no scenario can have it"), (("--near", 5), "no scenario can have it")):
            with self.subTest(words=words):
                self.assert_refused(self.run_throng("run", "hall.toml", *words), f"throng: {words[0]} goes with a world", "hall.toml", *named)

    def test_a_recording_of_a_scenario_with_pictures_is_repeated_from_any_folder(self):
        self.write_hall()
        (self.path / "below").mkdir()
        done = self.run_throng("run", "hall.toml", "--record", "hall.replay", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["entered"], 8)
        for words in (("replay", "../hall.replay", "--check"), ("report", "../hall.replay", "-o", "hall.html")):
            done = subprocess.run([PROGRAM, *words], cwd=self.path / "below", capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_units_are_refused_for_worlds_that_have_their_own(self):
        for words in (("--up", "z"), ("--scale", "0.01")):
            with self.subTest(words=words):
                self.assert_refused(self.run_throng("bake", "builtin:cube", "-o", "x.throng", *words), f"throng: {words[0]} is for model files; builtin:cube")
                self.assert_refused(self.run_throng("slices", "builtin:cube", *words), words[0], "builtin:cube")
                self.assert_refused(self.run_throng("verify", self.world, "--source", "builtin:garage", *words), words[0], "builtin:garage")
        (self.path / "scene.toml").write_text('[[source]]\npath = "a.obj"\n')
        (self.path / "a.obj").write_text("v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n")
        self.assert_refused(self.run_throng("bake", "--scene", "scene.toml", "--up", "z", "-o", "x.throng"), "--up", "write it into scene.toml")
        self.assertEqual(self.run_throng("bake", "a.obj", "builtin:cube", "--up", "z", "-o", "x.throng").returncode, 0)

    def test_pictures_of_slices_replace_all_of_before_and_nothing_else(self):
        cut = ("slices", "builtin:garage,size=45,levels=2", "--cell", 0.5, "--json", "--images", "pictures")
        done = self.run_throng(*cut, "--resolution", 0.05)
        self.assertEqual(done.returncode, 0, done.stderr)
        before = len(json.loads(done.stdout)["heights"])
        (self.path / "pictures" / "notes.txt").write_text("kept")
        for name in (before, before + 1):
            (self.path / "pictures" / f"slice_{name:03}.png").write_text("old")
        done = self.run_throng(*cut)
        self.assertEqual(done.returncode, 0, done.stderr)
        names = [f"slice_{n:03}.png" for n in range(len(json.loads(done.stdout)["heights"]))]
        self.assertEqual(sorted(path.name for path in (self.path / "pictures").iterdir()), ["notes.txt", *names])

    def test_a_folder_of_pictures_is_no_world_no_file_and_holds_no_other_output(self):
        (self.path / "file").write_text("kept")
        cube = ("slices", "builtin:cube", "--cell", 0.5)
        before = sorted(self.world.iterdir())
        for folder in (self.world, self.world / "nodes"):
            self.assert_refused(self.run_throng(*cube, "--images", folder), "throng: --images: ", "lies in a baked world")
            self.assert_refused(self.run_throng("atlas", "-o", "a.atlas", "--images", folder), "throng: --images: ", "lies in a baked world")
            self.assert_refused(self.run_throng("validate", "rimea.1", "-o", folder), "throng: --output: ", "lies in a baked world")
        self.assert_refused(self.run_throng(*cube, "--images", "file"), "throng: --images: file is a file; name a folder")
        self.assert_refused(self.run_throng(*cube, "--images", "d", "-o", "d/slice_000.png"), "throng: --output: d/slice_000.png is also a picture of --images")
        self.assertEqual(sorted(self.world.iterdir()), before)
        self.assertEqual([path.name for path in self.path.iterdir()], ["file"])
        self.assertEqual(self.run_throng(*cube, "--images", "d", "-o", "d/cube.slices").returncode, 0)

    def test_slices_that_do_not_exist_are_said_to_be_missing(self):
        for command in (("run", "none.slices", "--wander"), ("run", "none.slices"), ("slices", "none.slices")):
            self.assert_refused(self.run_throng(*command), "none.slices: cannot be read: No such file", "throng slices MODEL -o")
        (self.path / "text.slices").write_text("no slices at all\n")
        self.assert_refused(self.run_throng("run", "text.slices", "--wander"), "text.slices: not a file of slices")

    def test_bytes_after_the_end_of_slices_and_recordings_are_found(self):
        self.assertEqual(self.run_throng("slices", "builtin:cube", "--cell", 0.5, "-o", "cube.slices").returncode, 0)
        whole = (self.path / "cube.slices").read_bytes()
        for more in (b"\0", b"\0" * 4, b"more", whole):
            (self.path / "more.slices").write_bytes(whole + more)
            self.assert_refused(self.run_throng("slices", "more.slices"), "more.slices: has bytes after its end")
        done = self.run_throng("run", self.world, "--avatars", 5, "--steps", 5, "--record", "walk.replay")
        self.assertEqual(done.returncode, 0, done.stderr)
        content = (self.path / "walk.replay").read_bytes()
        (self.path / "walk.replay").write_bytes(content + b"\0")
        done = self.run_throng("replay", "walk.replay", "--json")
        self.assertIn(f"goes on after its end at byte {len(content)}; the first 6 frames are good", done.stderr)
        self.assertEqual((done.returncode, json.loads(done.stdout)["complete"]), (0, False))

    def test_the_summary_of_a_run_names_all_its_classes(self):
        run = ("run", self.world, "--avatars", 20, "--also", "giant:2", "--also", "child:3", "--steps", 3)
        done = self.run_throng(*run)
        self.assertIn("25 adult, giant, child avatars, 3 steps", done.stdout, done.stderr)
        self.assertEqual(json.loads(self.run_throng(*run, "--json").stdout)["also"], [["giant", 2], ["child", 3]])

    def test_options_of_one_run_and_of_many_are_not_mixed(self):
        for words, *named in ((("--figure10", "a.png", "--figure9", "b.png"), "--figure10", "--figure9"),
                              (("--figure11", "a.png", "--record", "b.csv"), "--figure11", "--record"),
                              (("--seeds", 3, "--record", "b.csv"), "--seeds", "--record"), (("--at", 3), "--at", "--figure9"),
                              (("--at", -1, "--figure9", "b.png"), "--at: -1 is below 0"),
                              (("--at", 900000, "--figure9", "b.png", "--record", "b.csv"), "--at 900000: the run ends at frame ")):
            with self.subTest(words=words):
                self.assert_refused(self.run_throng("caacd", "--avatars", "5,12", *words), *named)
                self.assertEqual(list(self.path.iterdir()), [])

    def test_gl_options_that_a_scenario_or_recording_does_not_obey_are_refused_by_name(self):
        self.write_hall()
        self.assertEqual(self.run_throng("run", "hall.toml", "--record", "hall.replay").returncode, 0)
        view, film = ("view", "--picture", "a.png"), ("film", "-o", "a.mp4")
        of_both = (("--avatars", 5), ("--near", 5), ("--sight", 50), ("--only-seen",), ("--coarse-far",), ("--density", "map.png"), ("--region", 2))
        for target in ("hall.toml", "hall.replay"):
            for words in (*of_both, ("--speed", 2), ("--dt", 0.2), ("--zones",), ("--cell", 0.2), ("--model", "caacd"), ("--axes", "side")):
                self.assert_refused(self.run_throng(*view, target, *words), f"{target}: {words[0]} is for", "leave it out")
            for words in of_both:
                self.assert_refused(self.run_throng(*film, target, *words), f"{target}: {words[0]} is for")
        self.assert_refused(self.run_throng(*view, "hall.replay", "--seed", 2), "hall.replay: --seed")
        self.assert_refused(self.run_throng(*view, "hall.toml", "--world", self.world), "hall.toml: --world is for recordings")
        self.assert_refused(self.run_throng(*view, self.world, "--up", "z"), "--up is for model files; name one")

    def test_an_atlas_has_parts_to_wear_and_refuses_what_does_not_fit(self):
        small = ("--frames", 2, "--directions", 2, "--elevations", 2, "--pixels", 16)
        done = self.run_throng("atlas", "--parts", *small, "-o", "a.atlas", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual({part["kind"] for part in said["worn"]}, {"hair", "hat", "coat", "bag", "skirt"})
        self.assertEqual(said["views"], (1 + len(said["worn"])) * 2 * 2 * 2)
        self.assert_refused(self.run_throng("atlas", "--wear", "cape=b.glb", "-o", "c.atlas"), "--wear", "cape=b.glb", "hair, hat, coat, bag or skirt")
        self.assert_refused(self.run_throng("atlas", "--wear", "hat=none.glb", "-o", "c.atlas"), "none.glb")
        self.assert_refused(self.run_throng("atlas", "b.glb", "--parts", "-o", "c.atlas"), "--parts")
        self.assertFalse((self.path / "c.atlas").exists())

    def test_gl_a_density_map_of_the_viewer_is_refused_by_name_where_it_says_nothing(self):
        view, film = ("view", self.world, "--picture", "a.png"), ("film", self.world, "-o", "a.mp4")
        (self.path / "map.png").write_bytes(grey_png([[0, 255], [0, 255]]))
        for command in (view, film):
            self.assert_refused(self.run_throng(*command, "--density", "map.png"), "--density goes with --only-seen")
            self.assert_refused(self.run_throng(*command, "--region", 2), "--region goes with --only-seen")
            self.assert_refused(self.run_throng(*command, "--only-seen", "--density-box", "0,0,9,9"), "--density-box goes with --density")
            self.assert_refused(self.run_throng(*command, "--only-seen", "--density", "none.png"), "none.png")
            self.assert_refused(self.run_throng(*command, "--only-seen", "--density", "map.png", "--density-box", "9,0,0,9"), "--density-box", "low corner")
        (self.path / "black.png").write_bytes(grey_png([[0]]))
        self.assert_refused(self.run_throng(*view, "--only-seen", "--density", "black.png"), "black.png", "weights are all 0")
        self.assert_refused(self.run_throng("run", self.world, "--density", "map.png"), "--density")
        self.assertFalse((self.path / "a.png").exists())

    def test_gl_the_viewer_runs_the_experiment_of_caacd_as_the_program_does(self):
        view = ("view", "builtin:caacd", "--picture", "a.png", "--width", 480, "--height", 320, "--json")
        words = ("--avatars", 40, "--set", "1.0/1.0/0.06", "--seed", 3)
        done = self.run_throng(*view, *words, "--after", 4000 / 60)
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads(done.stdout)
        one = self.run_throng("caacd", *words, "--record", "walk.csv", "--json")
        self.assertEqual(one.returncode, 0, one.stderr)
        one = json.loads(one.stdout)
        for key in ("frames", "collisions", "obstacle_collisions", "arrived", "waiting", "walked"):
            self.assertEqual(said["experiment"][key], one[key], key)
        self.assertEqual(sum(said["states"].values()), 40)
        for words, *named in ((("--model", "caacd"), "builtin:caacd: --model is not for the experiment"), (("--near", 5), "--near"),
                              (("--axes", "side"), "--axes"), (("--avatars", 0), "avatars"), (("--avatars", 4000), "avatars"),
                              (("--set", "1/2"), "--set 1/2"), (("--order", "mass"), "--order mass")):
            self.assert_refused(self.run_throng(*view, *words), *named)

    def test_gl_the_viewer_shows_the_states_of_a_crowd_that_caacd_steers(self):
        view = ("view", self.world, "--avatars", 60, "--after", 3, "--width", 480, "--height", 320, "--json")
        done = self.run_throng(*view, "--model", "caacd", "--set", "1.0/0.8/0.06", "--overlay", "Fields", "--pick", 3, "--panel",
                               "--picture", "a.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual(sum(said["states"].values()), said["avatars"])
        done = self.run_throng(*view, "--picture", "b.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("states", json.loads(done.stdout))
        self.assert_refused(self.run_throng(*view, "--set", "1.0/0.8/0.06", "--picture", "c.png"), "--set", "--model caacd")

    def test_gl_a_picture_counts_an_avatar_once(self):
        done = self.run_throng("view", self.world, "--avatars", 16, "--after", 0, "--picture", "a.png", "--width", 320, "--height", 180,
                               "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual(said["avatars"], 16)
        self.assertTrue(5 < said["drawn"] <= 16, said)

    def test_gl_a_view_of_more_avatars_than_fit_shows_those_that_fit(self):
        done = self.run_throng("bake", "builtin:cube", "--cell", "0.5", "-o", "cube.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = self.run_throng("view", "cube.throng", "--avatars", 2 ** 32 - 1, "--after", 0, "--picture", "a.png", "--width", 160,
                               "--height", 120, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(5 < json.loads(done.stdout)["avatars"] < 5000, done.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
