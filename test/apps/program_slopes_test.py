# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Runs of the program in a world with ramps: slopes slow avatars, unless they are to keep their speed.

python3 program_slopes_test.py build/release/throng"""
import json
import unittest

from program_case import ProgramCase

WALK = """{key}
world = "{world}"
[[area]]
name = "all"
box = [0, 0, 100, 100]
[[journey]]
name = "walk"
repeat = true
stages = [{{ random_point = "all" }}]
[[source]]
name = "all"
area = "all"
journey = "walk"
count = 200
"""


class ProgramSlopes(ProgramCase):
    def assert_repeats(self, recording):
        check = self.run_throng("replay", recording, "--check")
        self.assertEqual(check.returncode, 0, check.stderr)
        self.assertIn("all the same", check.stdout)

    def test_slopes_slow_avatars_of_a_crowd_and_its_recording_is_repeated_exactly(self):
        run = ("run", self.world, "--avatars", 200, "--steps", 100, "--json", "--record", "walk.replay")
        hashes = set()
        for option in ((), ("--full-speed",)):
            done = self.run_throng(*run, *option)
            self.assertEqual(done.returncode, 0, done.stderr)
            said = json.loads(done.stdout)
            self.assertEqual(said["slow_on_slopes"], not option)
            hashes.add(said["state_hash"])
            self.assert_repeats("walk.replay")
        self.assertEqual(len(hashes), 2)
        self.assert_refused(self.run_throng("run", self.world, "--wander", "--full-speed"), "--full-speed", "--wander")

    def test_a_scenario_states_whether_slopes_slow(self):
        file = self.path / "walk.toml"
        hashes = []
        for key, option, slow in (("", (), True), ("", ("--full-speed",), False), ("slow_on_slopes = false", (), False)):
            file.write_text(WALK.format(key=key, world=self.world))
            done = self.run_throng("run", file, "--steps", 100, "--json", "--record", "walk.replay", *option)
            self.assertEqual(done.returncode, 0, done.stderr)
            said = json.loads(done.stdout)
            self.assertEqual(said["slow_on_slopes"], slow)
            hashes.append(said["state_hash"])
            self.assert_repeats("walk.replay")
        self.assertNotEqual(hashes[0], hashes[1])
        self.assertEqual(hashes[1], hashes[2])


if __name__ == "__main__":
    unittest.main(verbosity=2)
