# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""The files that the checks read: those that git tracks or would track; without git, the folder without build outputs."""
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILT = {"build", "demo_out", "demo_out.part", ".git", ".cache", "__pycache__"}


def source_files():
    """Names relative to ROOT, sorted, without test data."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            cwd=ROOT, capture_output=True, check=False)
    if listed.returncode == 0 and listed.stdout:
        names = listed.stdout.decode().split("\0")
    else:
        paths = (path.relative_to(ROOT) for path in ROOT.rglob("*"))
        names = [str(path) for path in paths if not BUILT & set(path.parts)]
    for name in sorted(set(names)):
        if name and (ROOT / name).is_file() and not name.startswith(("test/data/", "test/fuzz/seeds/")):
            yield name
