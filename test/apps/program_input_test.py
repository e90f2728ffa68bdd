# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Files and values that the program refuses: folders, damaged recordings, outputs that are inputs, numbers out of range.

python3 program_input_test.py build/release/throng"""
import json
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


if __name__ == "__main__":
    unittest.main(verbosity=2)
