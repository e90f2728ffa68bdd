# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Files and values that the program refuses: folders, damaged recordings, outputs that are inputs, numbers out of range.

python3 program_input_test.py build/release/throng"""
import json
import os
import re
import unittest

from program_case import ProgramCase


class ProgramInput(ProgramCase):
    def test_a_folder_in_place_of_a_file_is_refused(self):
        (self.path / "folder").mkdir()
        run = ("run", self.world, "--avatars", 5, "--steps", 2)
        picture = ("picture", self.world, "-o", "a.png")
        for command in ((*run, "--goals", "folder"), (*picture, "--path", "folder"), (*picture, "--avatars", "folder"),
                        ("bake", "builtin:cube", "-o", "z.throng", "--off-mesh-links", "folder"),
                        ("bake", "builtin:cube", "-o", "z.throng", "--classes", "folder"),
                        ("bake", "builtin:cube", "-o", "z.throng", "--scene", "folder"),
                        ("replay", "folder"), ("report", "folder", "-o", "a.html")):
            with self.subTest(command=command):
                self.assert_refused(self.run_throng(*command), "folder: ")
        self.assert_refused(self.run_throng(*run, "--goals", "folder"), "is a folder, not a file", "random")
        self.assert_refused(self.run_throng(*picture, "--path", "none.json"), "none.json: cannot be read", "throng path")
        self.assertEqual([path.name for path in self.path.iterdir()], ["folder"])

    def test_a_recording_without_a_good_step_proves_and_exports_nothing(self):
        done = self.run_throng("run", self.world, "--avatars", 20, "--steps", 20, "--record", "whole.replay")
        self.assertEqual(done.returncode, 0, done.stderr)
        content = bytearray((self.path / "whole.replay").read_bytes())
        second = content.index(content[:4], 4)  # Each chunk begins with the mark of the first.
        content[second + 200] ^= 1
        (self.path / "bad.replay").write_bytes(content)
        done = self.run_throng("replay", "bad.replay", "--json")
        self.assertEqual((done.returncode, json.loads(done.stdout)["frames"]), (0, 0), done.stderr)
        for options in (("--check",), ("--at", 0), ("--csv", "a.csv"), ("--txt", "a.txt"), ("--sqlite", "a.sqlite")):
            with self.subTest(options=options):
                done = self.run_throng("replay", "bad.replay", *options)
                self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
                note, refusal = done.stderr.splitlines()
                self.assertIn("corrupt", note)
                self.assertIn("bad.replay: holds no", refusal)
        self.assert_refused(self.run_throng("report", "bad.replay", "-o", "a.html"), "bad.replay: holds no frame")
        self.assertEqual(sorted(path.name for path in self.path.iterdir()), ["bad.replay", "whole.replay"])
        whole = json.loads(self.run_throng("replay", "whole.replay", "--check", "--json").stdout)
        self.assertEqual((whole["hashes"], whole["complete"]), (21, True))

    def test_counts_below_zero_are_refused_and_do_not_wrap_around(self):
        run = ("run", self.world, "--avatars", 5, "--steps", 2)
        for command in ((*run[:4], "--steps", -1), (*run, "--seed", -1), (*run, "--check-every", -1), (*run, "--every", "-1"),
                        (*run[:2], "--avatars", -1), ("verify", self.world, "--source", "builtin:garage", "--samples", -1),
                        ("generate", "city", "-o", "a.glb", "--seed", -1), ("generate", "city", "-o", "a.glb", "--triangles", -1),
                        ("bench", "--steps", -1), ("query", self.world, "--at", "14,0,8", "--random", -1)):
            with self.subTest(command=command):
                self.assert_refused(self.run_throng(*command), f"{command[-2]}: ", "-1")
        self.assertEqual(list(self.path.iterdir()), [])

    def test_a_leading_zero_does_not_change_a_number(self):
        run = ("run", self.world, "--json")
        kept = ("avatars", "steps", "dt", "seed", "checks", "state_hash")
        plain = ("--avatars", "10", "--steps=12", "--seed", "9", "--dt", "0.1", "--check-every", "10", "--threads", "2")
        zeros = ("--avatars", "010", "--steps=0012", "--seed", "+09", "--dt", "00.1", "--check-every", " 010", "--threads", "02")
        before, after = (json.loads(self.run_throng(*run, *words).stdout) for words in (plain, zeros))
        self.assertEqual((before["avatars"], before["steps"], before["seed"]), (10, 12, 9))
        self.assertEqual({key: after[key] for key in kept}, {key: before[key] for key in kept})
        at = [self.run_throng("query", self.world, "--at", place, "--json").stdout for place in ("14,0,10", "014,00,+010")]
        self.assertIn("area", at[0])
        self.assertEqual(*at)
        for words in (("--levels", "010"), ("--seed", "010"), ("--triangles", "0100000")):
            files = []
            for value in (words[1], words[1].lstrip("0")):
                done = self.run_throng("generate", "garage" if words[0] == "--levels" else "city", words[0], value, "-o", "a.obj")
                self.assertEqual(done.returncode, 0, done.stderr)
                files.append((self.path / "a.obj").read_bytes())
            self.assertEqual(*files, words)
        self.assert_refused(self.run_throng("generate", "city", "--seed", "-010", "-o", "b.obj"), "--seed: -10 is below 0")

    def test_all_numbers_are_refused_in_hexadecimal(self):
        shown = self.run_throng("--help").stdout.partition("Subcommands:")[2]
        commands = re.findall(r"(?m)^  ([a-z]+) ", shown)
        self.assertIn("run", commands)
        viewer = () if re.search(r"(?m)^  view +Not in this build", shown) else ("--pick",)
        seen = set()
        for command in commands:
            shown = self.run_throng(command, "--help").stdout
            for name, kind in re.findall(r"(?m)^  (?:-\w,)?(--[a-z0-9-]+) (FLOAT|INT|UINT|N|S|ID|M|MIB|[A-Z0-9]+(?:,[A-Z0-9]+)+)(?=[ :=\n])", shown):
                with self.subTest(command=command, name=name):
                    values = ",".join(["0x10"] * len(kind.split(",")))
                    self.assert_refused(self.run_throng(command, f"{name}={values}"), f"throng: {name}: 0x10 is hexadecimal")
                    if kind in ("INT", "UINT", "N", "S", "ID"):
                        self.assert_refused(self.run_throng(command, f"{name}={'9' * 30}"), f"throng: {name}: {'9' * 30} is too large")
                seen.add((name, kind))
        self.assertGreater(len(seen), 60)
        for name in ("--steps", "--cell", "--threads", "--from", "--levels", "--search-memory", *viewer):
            self.assertIn(name, {name for name, _ in seen})
        self.assert_refused(self.run_throng("run", self.world, "--steps", "-0X10"), "--steps: -0X10 is hexadecimal")

    def test_each_command_limits_its_threads(self):
        for command in (("bake", "builtin:cube", "-o", "x.throng"), ("run", self.world, "--steps", 1), ("components", self.world),
                        ("path", self.world, "--from", "14,0,8", "--to", "20,0,8"), ("slices", "builtin:cube"),
                        ("verify", self.world, "--source", "builtin:garage"), ("caacd",), ("validate", "--list"),
                        ("atlas", "-o", "a.atlas"), ("bench",)):
            with self.subTest(command=command):
                self.assert_refused(self.run_throng(*command, "--threads", 99999), "--threads: 99999 is above ")
                self.assert_refused(self.run_throng(*command, "--threads", -1), "--threads: -1 is below 0")
        self.assertEqual(list(self.path.iterdir()), [])
        most = self.run_throng("run", self.world, "--avatars", 5, "--steps", 1, "--threads", 256)
        self.assertEqual(most.returncode, 0, most.stderr)
        self.assertNotIn("TBB", most.stderr)

    def test_an_empty_value_is_no_zero(self):
        run = ("run", self.world, "--avatars", 5, "--steps", 2)
        for command in ((*run[:2], "--avatars", ""), (*run[:4], "--steps", ""), (*run, "--threads", ""), (*run, "--seed", ""),
                        (*run, "--speed", ""), (*run, "--radius", ""), (*run, "--near", ""), (*run, "--class", ""),
                        (*run, "--record", ""), ("query", self.world, "--at", ""), ("replay", "x.replay", "--at", ""),
                        ("generate", "garage", "-o", "a.glb", "--levels", ""), ("bake", "builtin:cube", "-o", ""),
                        ("bake", "builtin:cube", "-o", "x.throng", "--cell", "")):
            with self.subTest(command=command):
                self.assert_refused(self.run_throng(*command), f"{'--output' if command[-2] == '-o' else command[-2]}: ")
        ends = ("path", self.world, "--to", "20,0,8", "--from")
        self.assert_refused(self.run_throng(*ends, "1,,3"), "--from: wants X,Y,Z, and got 1,,3;")
        self.assert_refused(self.run_throng(*ends, "14,,0,8"), "--from: 14,,0,8 leaves out a value; write X,Y,Z;")
        self.assert_refused(self.run_throng(*ends[:-1], "--from=14,0,8,"), "--from: 14,0,8, leaves out a value;")
        self.assert_refused(self.run_throng(*ends, "1e30,0,8"), "--from (1e+30, 0.000, 8.000) lies outside")
        self.assertEqual(list(self.path.iterdir()), [])

    def test_no_output_is_written_over_an_input(self):
        done = self.run_throng("run", self.world, "--avatars", 5, "--steps", 4, "--record", "a.replay", "--trajectories", "a.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.run_throng("generate", "cube", "-o", "m.glb").returncode, 0)
        (self.path / "link.replay").symlink_to("a.replay")
        (self.path / "hard.replay").hardlink_to(self.path / "a.replay")
        (self.path / "s.toml").write_text("")
        manifest = self.world / "manifest.thm"
        before = {path: path.read_bytes() for path in [*self.path.iterdir(), *self.world.iterdir()]}
        run = ("run", self.world, "--avatars", 5, "--steps", 2)
        for option, *command in (("--csv", "replay", "a.replay", "--csv", "a.replay"), ("--txt", "replay", "a.replay", "--txt", "./a.replay"),
                                 ("--sqlite", "replay", "a.replay", "--sqlite", "link.replay"),
                                 ("--csv", "replay", "a.replay", "--csv", "hard.replay"),
                                 ("--output", "report", "a.replay", "-o", "a.replay"),
                                 ("--output", "picture", self.world, "--avatars", "a.csv", "-o", "a.csv"),
                                 ("--output", "atlas", "m.glb", "-o", "m.glb"),
                                 ("--record", *run, "--goals", "a.csv", "--record", "a.csv"),
                                 ("--record", "run", "s.toml", "--record", "s.toml"),
                                 ("--record", *run, "--record", manifest), ("--output", "export", self.world, "-o", manifest),
                                 ("--csv", "replay", "a.replay", "--csv", self.world / "new.csv"),
                                 ("--record", *run, "--record", "."), ("--output", "generate", "cube", "-o", "."),
                                 ("--trajectories", *run, "--record", "new", "--trajectories", "new"),
                                 ("--csv", "replay", "a.replay", "--csv", "new", "--txt", f"../{self.path.name}/new")):
            with self.subTest(command=command):
                self.assert_refused(self.run_throng(*command), f"throng: {option}: ", "name a")
                self.assertEqual({path: path.read_bytes() for path in [*self.path.iterdir(), *self.world.iterdir()]}, before)
        os.mkfifo(self.path / "pipe")  # A file that is renamed when it is whole would replace it.
        self.assert_refused(self.run_throng("replay", "a.replay", "--csv", "pipe"), "--csv: pipe is no regular file")
        self.assertTrue((self.path / "pipe").is_fifo())

    def test_a_refused_value_is_named_by_its_option_and_in_its_unit(self):
        view = ("picture", self.world, "--camera", "30,12,40,20,2,20", "-o", "a.png")
        for command in ((*view, "--width", -1), (*view, "--height", -1), (*view, "--view-angle", 200), (*view, "--view-angle", 0),
                        ("caacd", "--psi", 0), ("caacd", "--t3", 0), ("caacd", "--zone-time", -1), ("caacd", "--lambda1", 0),
                        ("caacd", "--obstacles", 1001), ("caacd", "--avatars", 2001)):
            with self.subTest(command=command):
                self.assert_refused(self.run_throng(*command), f"throng: {command[-2]}: {command[-1]} is ")
        run = ("run", self.world, "--steps", 1, "--avatars", 5)
        self.assert_refused(self.run_throng(*run, "--also", "dragon:5"), "throng: --also dragon: ", "adult")
        self.assert_refused(self.run_throng(*run, "--class", "dragon"), "throng: --class dragon: ", "adult")
        self.assert_refused(self.run_throng("bake", "builtin:cube", "-o", "x.throng", "--zone", 0), "zone", "above 0 m")
        ends = ("path", self.world, "--from", "14,0,8", "--to", "20,0,8")
        for kind in ("5.5", "0", "99"):
            self.assert_refused(self.run_throng(*ends, "--area", f"14,-1,7,15,2,9,{kind}"), f"--area: {kind} is no kind", "1 to 63")
        self.assert_refused(self.run_throng(*ends, "--off-mesh-link", "14,0,8,14,0,8"), "--off-mesh-link (14.000", "two different places")
        self.assertEqual(list(self.path.iterdir()), [])

    def test_words_that_a_command_does_not_take_are_named_in_their_order(self):
        self.assert_refused(self.run_throng("surface", self.world, "--at", "14,0,8"), "throng: --at: throng surface has no such option;")
        self.assert_refused(self.run_throng("info", self.world, "more", "--at"), "throng: more: throng info takes fewer words;")
        for command in ("components", "verify"):
            source = ("--source", "builtin:garage") if command == "verify" else ()
            self.assert_refused(self.run_throng(command, self.world, *source, "--class", "horse"), "--class horse: ", "adult", "giant", "all")

    def test_a_bake_prints_the_size_and_what_is_strange_about_it(self):
        for name, scale, hint in (("a", 1, ""), ("b", 0.01, "check the unit (--scale)")):
            corners = [(x * scale, y * scale, z * scale) for y in (0, 6) for x, z in ((0, 0), (20, 0), (20, 30), (0, 30))]
            sides = ("4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8")
            (self.path / f"{name}.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(f"f {s}\n" for s in sides))
            done = self.run_throng("bake", f"{name}.obj", "-o", f"{name}.throng", "--cell", "0.2")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"\n  {20 * scale:.1f} x {30 * scale:.1f} m, {6 * scale:.1f} m high\n", done.stdout)
            self.assertEqual(hint in done.stdout and hint != "", hint != "")
            hints = json.loads(self.run_throng("bake", f"{name}.obj", "-o", f"{name}.throng", "--cell", "0.2", "--json").stdout)["hints"]
            self.assertEqual([hint in text for text in hints], [True] if hint else [])

    def test_what_is_no_world_is_not_to_be_written_over(self):
        (self.path / "notes.txt").write_text("kept")
        for name, remedy in (("notes.txt", "-o WORLD.throng`"), (".", "-o WORLD.throng`"), ("new.throng", "-o new.throng`")):
            self.assert_refused(self.run_throng("info", name), f"{name}: not a baked world", remedy)

    def test_a_flyer_is_put_on_foot_by_the_option_that_is_named(self):
        done = self.run_throng("bake", "builtin:cube", "--fly", "--cell", "0.2", "-o", "cube.throng")
        self.assertEqual(done.returncode, 0, done.stderr)
        ends = ("path", "cube.throng", "--from", "2,3,2", "--to", "4,3,4", "--class", "flyer")
        for option in (("--off-mesh-link", "2,3,2,4,3,4"), ("--area", "2,2,2,4,4,4,5"), ("--area-cost", "5=2"), ("--slope-cost", "1")):
            self.assert_refused(self.run_throng(*ends, *option), "--from", "can stand", f"on foot because of {option[0]};")
        self.assertNotIn("because", self.run_throng(*ends, "--on-foot", "--slope-cost", 1).stderr)

    def test_no_class_is_named_all(self):
        (self.path / "classes.toml").write_text('[[class]]\nname = "adult"\n[[class]]\nname = "all"\n')
        self.assert_refused(self.run_throng("bake", "builtin:cube", "-o", "x.throng", "--classes", "classes.toml"),
                            "classes.toml", "named all", "another name")
        self.assertEqual([path.name for path in self.path.iterdir()], ["classes.toml"])

    def test_info_prints_bounds_nodes_and_numbers_with_their_nouns(self):
        info = self.run_throng("info", self.world).stdout
        bounds = json.loads(self.run_throng("info", self.world, "--json").stdout)
        corners = [", ".join(f"{v:.3f}" for v in bounds[name]) for name in ("bounds_min", "bounds_max")]
        self.assertIn(f"from ({corners[0]}) to ({corners[1]})\n", info)
        self.assertIn("no nodes", info)
        self.assertNotIn("nodes", bounds)
        done = self.run_throng("bake", "builtin:cube", "--cell", "0.2", "--nodes", "--fly", "-o", "n.throng", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        count = json.loads(done.stdout)["nodes"]
        info = self.run_throng("info", "n.throng").stdout
        self.assertIn(f"\n{count} nodes for paths", info)
        self.assertIn(" boxes, ", info)
        self.assertEqual(json.loads(self.run_throng("info", "n.throng", "--json").stdout)["nodes"], count)
        self.assertIn("; 1 zone, ", info)
        self.assertIn(", 1 segment, ", self.run_throng("path", self.world, "--from", "14,0,8", "--to", "20,0,8").stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
