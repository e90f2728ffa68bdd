# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Old names of commands and options: they work with a note.

python3 old_names_test.py build/release/throng"""
import re
import unittest

from program_case import ProgramCase


class OldNames(ProgramCase):
    def test_they_work_with_a_note_and_no_help_shows_them(self):
        at, ends = ("--at", "14,0,8"), ("--from", "14,0,8", "--to", "20,0,8")
        for old, new in ((("place", self.world, *at), ("query", self.world, *at)),
                         (("region", self.world, "--limit", "1"), ("components", self.world, "--limit", "1")),
                         (("world", "--list"), ("generate", "--list")),
                         (("path", self.world, *ends, "--reach=2"), ("path", self.world, *ends, "--tolerance=2"))):
            before, now = self.run_throng(*old), self.run_throng(*new)
            self.assertEqual((before.returncode, now.returncode, now.stderr), (0, 0, ""), before.stderr)
            names = next((a.split("=")[0], b.split("=")[0]) for a, b in zip(old, new) if a != b)
            self.assertEqual(before.stderr, "throng: note: '%s' is now '%s'\n" % names)
            seconds = r'[0-9.]+ m?s\b'
            self.assertEqual(re.sub(seconds, "", before.stdout), re.sub(seconds, "", now.stdout))
        for words, note in ((("nodes", self.world), "'nodes' is now 'surface'"), (("run", self.world, "--visits", "v.csv"), "'--visits' is now '--trips'"),
                            (("bake", "builtin:cube", "-o", "x", "--jumps", "none.json"), "'--jumps' is now '--off-mesh-links'"),
                            (("bake", "none.obj", "-o", "x", "--fresh"), "'--fresh' is now '--rebuild'"),
                            (("path", self.world, *ends, "--jump", "14,0,8,19,0,99"), "'--jump' is now '--off-mesh-link'")):
            done = self.run_throng(*words)
            self.assertEqual((done.returncode, done.stderr.splitlines()[0]), (2, f"throng: note: {note}"), done.stderr)
        for command, names in (((), ("nodes", "place", "region", "world")), (("path",), ("--reach", "--jump")), (("run",), ("--visits",)),
                               (("bake",), ("--jumps", "--fresh"))):
            shown = self.run_throng(*command, "--help").stdout
            for name in names:
                self.assertNotRegex(shown, rf"(?m)^  {name}\b")


if __name__ == "__main__":
    unittest.main(verbosity=2)
