# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Runs of the program state whether avatars avoid jams and queue, and recordings repeat it.

python3 program_jams_test.py build/release/throng"""
import json
import unittest

from program_case import ProgramCase


class ProgramJams(ProgramCase):
    def test_a_run_states_whether_avatars_avoid_jams_and_its_recording_is_repeated_exactly(self):
        run = ("run", self.world, "--avatars", 200, "--steps", 300, "--json", "--record", "walk.replay")
        for option in ((), ("--ignore-jams",)):
            done = self.run_throng(*run, *option)
            self.assertEqual(done.returncode, 0, done.stderr)
            said = json.loads(done.stdout)
            self.assertEqual(said["avoid_jams"], not option)
            self.assertGreaterEqual(said["jam_searches"], said["changed_route"])
            if option:
                self.assertEqual(said["jam_searches"], 0)
            check = self.run_throng("replay", "walk.replay", "--check")
            self.assertEqual(check.returncode, 0, check.stderr)
            self.assertIn("all the same", check.stdout)
    def test_a_run_states_whether_avatars_push_and_its_recording_is_repeated_exactly(self):
        (self.path / "wait.toml").write_text(
            """
builtin = { name = "cube" }
seconds = 20
[[area]]
name = "all"
box = [1, 1, 9, 9]
[[journey]]
name = "wait"
stages = [{ go = "all" }, { wait = 10 }]
[[source]]
name = "source"
area = "all"
journey = "wait"
count = 10
"""
        )
        world = ("run", self.world, "--avatars", 200, "--steps", 100)
        for run in (world, ("run", "wait.toml")):
            positions = []
            for option in ((), ("--pushing",)):
                done = self.run_throng(*run, *option, "--json", "--record", "walk.replay", "--trajectories", "walk.csv")
                self.assertEqual(done.returncode, 0, done.stderr)
                said = json.loads(done.stdout)
                self.assertEqual((said["pushing"], said["acceleration"]), (bool(option), 0 if option else 4))
                positions.append((self.path / "walk.csv").read_text())
                check = self.run_throng("replay", "walk.replay", "--check")
                self.assertEqual(check.returncode, 0, check.stderr)
                self.assertIn("all the same", check.stdout)
            self.assertNotEqual(positions[0], positions[1], run)
        self.assert_refused(self.run_throng("run", self.world, "--wander", "--pushing"), "--pushing", "--wander")

    def test_wanderers_know_no_jams(self):
        self.assert_refused(self.run_throng("run", self.world, "--wander", "--ignore-jams"), "--ignore-jams", "--wander")


if __name__ == "__main__":
    unittest.main(verbosity=2)
