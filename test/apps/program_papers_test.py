# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""The papers' own algorithms as the program runs them: slices, wanderers on them, CAACD.

python3 program_papers_test.py build/release/throng"""
import json
import unittest

from program_case import ProgramCase


class ProgramPapers(ProgramCase):
    def test_the_experiment_of_caacd_is_the_same_for_any_threads_and_writes_its_files(self):
        def study(*more):
            done = self.run_throng("caacd", "--avatars", "5,20", "--seeds", 3, "--frames", 400, *more)
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout
        reports = [json.loads(study("--json", "--threads", threads)) for threads in (1, 2, 5)]
        self.assertEqual(len({report["state_hash"] for report in reports}), 1)
        self.assertEqual([row["set"] for row in reports[0]["sets"]], ["1.0/1.0/0.06", "1.0/0.8/0.06", "2.0/0.4/0.06"])
        self.assertEqual(reports[0]["reported"], {"bad": [2, 4], "others": [2, 4]})
        self.assertNotEqual(json.loads(study("--json", "--seed", 7))["state_hash"], reports[0]["state_hash"])
        text = study("--figure10", "ten.png", "--figure11", "eleven.png")
        self.assertIn("2.0/0.4/0.06", text)
        self.assertIn("<= 4", text)
        self.assertEqual(len(study("--grid").splitlines()), 3 + 60)
        one = self.run_throng("caacd", "--avatars", 12, "--figure9", "nine.png", "--record", "walk.csv", "--json")
        self.assertEqual(one.returncode, 0, one.stderr)
        head, *lines = (self.path / "walk.csv").read_text().splitlines()
        self.assertEqual(head, "frame,id,x,z,vx,vz,activity,tangential,centripetal,state,threat")
        self.assertEqual(len(lines), 12 * (json.loads(one.stdout)["frames"] + 1))
        self.assertTrue(lines[-1].split(",")[6] in ("arrived", "waiting"), lines[-1])
        for cells in (line.split(",") for line in lines):
            self.assertEqual(cells[6] == "avoiding", cells[9] != "tolerable", cells)
            self.assertEqual(cells[9] != "tolerable", cells[10] != "", cells)
        self.assertEqual({line.split(",")[9] for line in lines}, {"tolerable", "alert", "critical"})
        by_state = self.run_throng("caacd", "--avatars", 12, "--record", "state.csv", "--order", "state", "--json")
        self.assertEqual(by_state.returncode, 0, by_state.stderr)
        self.assertIn(",collision,", (self.path / "state.csv").read_text())
        for name in ("nine.png", "ten.png", "eleven.png"):
            self.assertTrue((self.path / name).read_bytes().startswith(b"\x89PNG"), name)

    def test_bad_settings_of_caacd_are_one_sentence(self):
        for words, *named in ((("--set", "2.0/0.4"), "--set", "MASS/SPEED/FORCE"), (("--set", "2/x/1"), "--set 2/x/1"),
                              (("--set", "0/1/1"), "mass", "0.0/1.0/1.00"), (("--trigger", "far"), "--trigger far", "zones"),
                              (("--length", "long"), "--length long", "max-sum"),
                              (("--order", "mass"), "--order mass", "state"), (("--avatars", "20,5"), "--avatars"),
                              (("--avatars", "0"), "avatars"), (("--seeds", "0"), "seeds"), (("--t3", "-1"), "--t3: -1 is not above 0"),
                              (("--fields", "5,4,3"), "radii"), (("--fields", "5,4"), "--fields"),
                              (("--side", "50", "--avatars", "90"), "no room"), (("--lambda3", "2"), "lambda3"),
                              (("--avatars", "5", "--figure10", "x.png"), "two numbers"),
                              (("--avatars", "5", "--record", "no/x.csv"), "no/x.csv"),
                              (("--avatars", "5", "--seeds", "1", "--dt", "0"), "dt")):
            self.assert_refused(self.run_throng("caacd", *words), *named)
        self.assertEqual(list(self.path.iterdir()), [])

    def test_slices_are_written_opened_shown_and_walked_on(self):
        cut = self.run_throng("slices", "builtin:garage,size=45,levels=2", "--cell", 0.2, "-o", "garage.slices", "--json")
        self.assertEqual(cut.returncode, 0, cut.stderr)
        cut = json.loads(cut.stdout)
        shown = self.run_throng("slices", "garage.slices", "--images", "pictures", "--json")
        self.assertEqual(shown.returncode, 0, shown.stderr)
        shown = json.loads(shown.stdout)
        for key in ("heights", "taken", "kept", "extra", "bytes", "width", "depth", "cell", "avatar_height", "resolution"):
            self.assertEqual(shown[key], cut[key], key)
        self.assertEqual(len(list((self.path / "pictures").iterdir())), len(cut["heights"]))
        run = ("run", "garage.slices", "--wander", "--avatars", 80, "--also", "giant:5", "--steps", 60)
        states = set()
        for threads in (1, 2, 5):
            done = self.run_throng(*run, "--threads", threads, "--trajectories", f"walk{threads}.csv", "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            said = json.loads(done.stdout)
            self.assertEqual((said["avatars"], said["overlaps"], said["wall_entries"]), (85, 0, 0))
            self.assertEqual(said["also"], [["giant", 5]])
            self.assertGreater(said["moved"], 1000)
            states.add(said["state_hash"])
        self.assertEqual(len(states), 1)
        lines = (self.path / "walk1.csv").read_text().splitlines()
        self.assertEqual(len(lines), 1 + 85 * 61)
        self.assertEqual({line.split(",")[2] for line in lines[1:]}, {"adult", "giant"})

    def test_what_slices_cannot_do_is_refused_in_one_sentence(self):
        self.assertEqual(self.run_throng("slices", "builtin:cube", "--cell", 0.5, "-o", "cube.slices").returncode, 0)
        data = (self.path / "cube.slices").read_bytes()
        (self.path / "cut.slices").write_bytes(data[:200])
        (self.path / "bit.slices").write_bytes(data[:-40] + bytes([data[-40] ^ 1]) + data[-39:])
        for words, *named in ((("run", "cube.slices"), "cube.slices", "--wander"),
                              (("run", "cube.slices", "--wander", "--class", "elf"), "elf", "giant"),
                              (("run", "cube.slices", "--wander", "--class", "child"), "child", "--avatar-height 1.1"),
                              (("run", "cube.slices", "--wander", "--also", "giant"), "--also giant", "CLASS:N"),
                              (("run", "cube.slices", "--wander", "--goals", "random"), "--goals"),
                              (("run", "cube.slices", "--wander", "--record", "a.replay"), "--record", "--trajectories"),
                              (("run", "cube.slices", "--wander", "--avatars", 1000000), "avatars fit"),
                              (("run", "cut.slices", "--wander"), "cut.slices", "truncated"),
                              (("slices", "bit.slices"), "bit.slices", "damaged"),
                              (("slices", "cube.slices", "--cell", "0.2"), "cube.slices", "--cell"),
                              (("slices", "cube.slices", "-o", "again.slices"), "--output"),
                              (("run", self.world, "--set", "2.0/0.4/0.06"), "--set", "--model caacd"),
                              (("run", self.world, "--model", "caacd", "--set", "2.0/0.4"), "--set 2.0/0.4"),
                              (("run", self.world, "--model", "caacd", "--set", "0/1/1"), "mass"),
                              (("run", self.world, "--wander", "--order", "state"), "--order")):
            self.assert_refused(self.run_throng(*words), *named)

    def test_wanderers_of_several_classes_are_recorded_and_repeated(self):
        run = ("run", self.world, "--wander", "--avatars", 60, "--also", "giant:4", "--also", "child:30", "--steps", 40)
        done = self.run_throng(*run, "--record", "walk.replay", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        said = json.loads(done.stdout)
        self.assertEqual((said["avatars"], said["overlaps"], said["wall_entries"]), (94, 0, 0))
        check = self.run_throng("replay", "walk.replay", "--check")
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn("all the same", check.stdout)
        self.assert_refused(self.run_throng("run", self.world, "--wander", "--also", "elf:3"), "elf")

    def test_a_set_of_caacd_steers_a_crowd_and_is_recorded(self):
        states = set()
        for words in ((), ("--set", "1.0/0.8/0.06"), ("--order", "state"), ("--set", "2.0/0.4/0.06")):
            done = self.run_throng("run", self.world, "--model", "caacd", "--avatars", 120, "--steps", 60, *words,
                                   "--record", "walk.replay", "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            said = json.loads(done.stdout)
            self.assertEqual((said["overlaps"], said["wall_entries"]), (0, 0))
            states.add(said["state_hash"])
            check = self.run_throng("replay", "walk.replay", "--check")
            self.assertEqual(check.returncode, 0, check.stderr)
            self.assertIn("all the same", check.stdout)
        self.assertEqual(len(states), 3, "the last set is the default")

    def test_sets_that_change_in_a_run_are_recorded_and_others_refused_by_name(self):
        run = ("run", self.world, "--model", "caacd", "--avatars", 80, "--steps", 50)
        states = set()
        for words in ((), ("--set-at", "20:1.0/0.8/0.06"), ("--set-at", "20:7:1.0/0.8/0.06"),
                      ("--set-at", "20:7:1.0/0.8/0.06", "--set-at", "35:7:2.0/0.4/0.06"), ("--set-at", "900:1.0/0.8/0.06")):
            done = self.run_throng(*run, *words, "--record", "walk.replay", "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            said = json.loads(done.stdout)
            self.assertEqual((said["overlaps"], said["wall_entries"]), (0, 0))
            states.add(said["state_hash"])
            check = self.run_throng("replay", "walk.replay", "--check", "--threads", 1)
            self.assertEqual(check.returncode, 0, check.stderr)
            self.assertIn("all the same", check.stdout)
        self.assertEqual(len(states), 4, "step 900 is never made")
        for words, *named in ((("--set-at", "20"), "--set-at 20", "STEP:AVATAR:MASS/SPEED/FORCE"), (("--set-at", "x:1/1/1"), "x:1/1/1"),
                              (("--set-at", "2:80:1/1/1"), "--set-at 80", "80 avatars"), (("--axes", "up"), "--axes up", "side-and-up"),
                              (("--model", "sampled", "--axes", "side"), "--axes", "--model caacd"),
                              (("--model", "sampled", "--set-at", "1:1/1/1"), "--set-at", "--model caacd")):
            self.assert_refused(self.run_throng(*(w for w in run if "--model" not in words or w not in ("--model", "caacd")), *words),
                                *named)


if __name__ == "__main__":
    unittest.main(verbosity=2)
