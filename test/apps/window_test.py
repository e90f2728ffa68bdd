# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""A real window on its own display, driven with keys and mouse through XTest; its pictures are read from the display.

window_test.py THRONG. Needs Xvfb and xdotool: without them it fails."""
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time

WIDTH, HEIGHT = 640, 400


def screen(path):
    """Rows of (red, green, blue) of the display's memory, an XWD file."""
    data = path.read_bytes()
    head = struct.unpack(">25I", data[:100])
    size, width, height, bits, line, colours = head[0], head[4], head[5], head[11], head[12], head[19]
    assert bits == 32, bits
    first = size + 12 * colours
    little = head[7] == 0
    rows = []
    for y in range(height):
        row = data[first + y * line:first + y * line + 4 * width]
        rows.append([(row[i + 2], row[i + 1], row[i]) if little else (row[i + 1], row[i + 2], row[i + 3])
                     for i in range(0, 4 * width, 4)])
    return rows


def differing(a, b):
    return sum(max(abs(p - q) for p, q in zip(u, v)) > 24 for r, s in zip(a, b) for u, v in zip(r, s))


class Window:
    def __init__(self, throng, folder, *arguments):
        self.folder = folder
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", f"{WIDTH}x{HEIGHT}x24",
                                        "-fbdir", str(folder), "-nolisten", "tcp"], pass_fds=[write],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            display = pipe.readline().strip()
        self.env = dict(os.environ, DISPLAY=f":{display}", XDG_CONFIG_HOME=str(folder / "config"),
                        XDG_CACHE_HOME=str(folder / "cache"))
        self.log = open(folder / "log", "w")
        self.program = subprocess.Popen([throng, "view", *arguments, "--width", str(WIDTH), "--height", str(HEIGHT)],
                                        env=self.env, cwd=folder, stdout=self.log, stderr=subprocess.STDOUT)

    def do(self, *words):
        subprocess.run(["xdotool", *words], env=self.env, check=True, stdout=subprocess.DEVNULL)

    def look(self):
        return screen(self.folder / "Xvfb_screen0")

    def wait(self, what, until, seconds=90):
        """Looks until `until(picture)` holds."""
        end = time.time() + seconds
        while time.time() < end:
            if self.program.poll() is not None:
                raise SystemExit(f"the program ended early: {(self.folder / 'log').read_text()}")
            picture = self.look()
            if until(picture):
                return picture
            time.sleep(0.3)
        raise SystemExit(f"never seen: {what}; {(self.folder / 'log').read_text()}")

    def wait_until_still(self, seconds=90):
        """Looks until nothing but the panel's numbers changes for two seconds: a busy machine is slow."""
        end = time.time() + seconds
        last = self.look()
        while time.time() < end:
            time.sleep(2)
            now = self.look()
            if differing(now, last) < 400:
                return now
            last = now
        raise SystemExit("it goes on though it is paused")

    def close(self):
        for process in (self.program, self.server):
            if process.poll() is None:
                process.kill()
                process.wait()


def check(window):
    black = (0, 0, 0)
    bright = window.wait("a scene", lambda p: sum(pixel != black for row in p for pixel in row) > WIDTH * HEIGHT * 0.9)
    assert differing(bright, [[black] * WIDTH] * HEIGHT) > WIDTH * HEIGHT // 2
    # Only the progress bar of the load has this yellow.
    window.wait("the end of the load", lambda p: not any(
        red > 200 and 150 < green < 200 and blue < 30 for row in p[HEIGHT // 2:] for red, green, blue in row), 300)
    # An avatar walks: the picture changes by itself.
    still = window.look()
    window.wait("an avatar that walks", lambda p: differing(p, still) > 30)
    window.do("mousemove", str(WIDTH - 60), str(HEIGHT // 2))
    window.do("key", "space")  # Pause.
    paused = window.wait_until_still()
    window.do("key", "Tab")
    without = window.wait("no panel after Tab", lambda p: differing(p, paused) > 8000)
    window.do("key", "F1")
    keys = window.wait("the keys after F1", lambda p: differing(p, without) > 8000)
    window.do("key", "Escape")
    # Not the same picture as before: hints come and go.
    without = window.wait("no keys after Escape", lambda p: differing(p, keys) > 8000)
    # The drag begins and ends between two frames.
    window.do("mousedown", "1", "mousemove_relative", "--", "-80", "15", "mousemove_relative", "--", "-80", "15", "mouseup", "1")
    window.wait("another side after a drag", lambda p: differing(p, without) > 8000)
    window.do("key", "F12")
    window.wait("a picture kept", lambda p: (window.folder / "throng-001.png").exists())
    window.do("key", "ctrl+q")
    window.program.wait(timeout=60)
    assert window.program.returncode == 0, window.program.returncode
    settings = (window.folder / "config/throng/view.json").read_text()
    assert '"panel": false' in settings, settings


def main():
    if not shutil.which("Xvfb") or not shutil.which("xdotool"):
        print("window_test: no Xvfb or no xdotool; scripts/install_deps installs them")
        return 1
    with tempfile.TemporaryDirectory() as name:
        window = Window(sys.argv[1], pathlib.Path(name), "builtin:stairs", "--avatars", "60", "--near", "5")
        try:
            check(window)
        finally:
            window.close()
            window.log.close()
    print("window_test: ok")
    return 0


sys.exit(main())
