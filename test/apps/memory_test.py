# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Memory of a program that draws: flat from picture to picture, on Mesa's software OpenGL, too.

memory_test.py THRONG city     100 pictures of a large scene, at most 760 MB
memory_test.py THRONG overlay  300 pictures with Clearance
memory_test.py THRONG window   15 s of a window with Clearance. It needs Xvfb and xdotool, films need ffmpeg: without
them the test fails."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

MOST_MB = 760  # 669 to 709 MB in three runs: how much of it the driver holds depends on the other load.
FLAT_MB = 100  # Chunks of the allocator, buffers of the driver that grow once or twice.


def resident_mb(process):
    """Resident set now and at its peak [MB], or none if the process has ended."""
    try:
        text = pathlib.Path(f"/proc/{process}/status").read_text(encoding="ascii")
    except OSError:
        return None
    values = {line.split()[0]: int(line.split()[1]) / 1000 for line in text.splitlines() if line.startswith(("VmRSS", "VmHWM"))}
    return (values["VmRSS:"], values["VmHWM:"]) if len(values) == 2 else None


def film(throng, folder, pictures, *arguments):
    """Makes a film. Returns the resident sets while it is made [MB], with the peak as the last."""
    output = folder / "film.mp4"
    begun = folder / "film.part.mp4"  # ffmpeg makes it when the first picture comes.
    program = subprocess.Popen([throng, "film", *arguments, "--seconds", str(pictures / 10), "--rate", "10",
                                "--threads", "2", "-o", str(output)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    samples, peak = [], 0
    while program.poll() is None:
        now = resident_mb(program.pid)
        if now:
            peak = now[1]
            if begun.exists():
                samples.append(now[0])
        time.sleep(0.02)
    said = program.communicate()
    assert program.returncode == 0, said
    assert f"{pictures} pictures" in said[0], said
    assert len(samples) > 20, len(samples)
    return samples + [peak]


def check_flat(samples):
    """After the first quarter the memory must not grow."""
    early, late = max(samples[:len(samples) // 4]), max(samples[len(samples) // 4:-1])
    print(f"memory_test: {early:.0f} MB in the first quarter, {late:.0f} MB after it, {samples[-1]:.0f} MB at the peak")
    assert late < early + FLAT_MB, "grows from picture to picture"
    assert samples[-1] <= MOST_MB, f"more than {MOST_MB} MB"


def window(throng, folder):
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "640x400x24", "-nolisten", "tcp"],
                              pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as pipe:
        env = dict(os.environ, DISPLAY=f":{pipe.readline().strip()}")
    program = subprocess.Popen([throng, "view", "builtin:garage", "--avatars", "20", "--width", "640", "--height", "400", "--forget"],
                               env=env, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        # The load is over when memory stays the same for five seconds.
        last, since, end = 0, time.time(), time.time() + 200
        while time.time() < since + 5 and time.time() < end:
            time.sleep(0.5)
            now = resident_mb(program.pid)
            assert now, "the program ended early"
            if abs(now[0] - last) > 5:
                last, since = now[0], time.time()
        subprocess.run(["xdotool", "key", "c"], env=env, check=True, stdout=subprocess.DEVNULL)
        samples = []
        for _ in range(60):
            time.sleep(0.25)
            samples.append(resident_mb(program.pid)[0])
        check_flat(samples + [resident_mb(program.pid)[1]])
    finally:
        for process in (program, server):
            process.kill()
            process.wait()


def main():
    throng, case = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2]
    needed = ["Xvfb", "xdotool"] if case == "window" else ["ffmpeg"]
    if not all(shutil.which(tool) for tool in needed):
        print(f"memory_test: no {' or no '.join(needed)}; scripts/install_deps installs them")
        return 1
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if case == "window":
            window(throng, folder)
        elif case == "city":
            check_flat(film(throng, folder, 100, "builtin:city,size=600", "--avatars", "20", "--width", "160", "--height", "90"))
        else:
            check_flat(film(throng, folder, 300, "builtin:stairs", "--avatars", "5", "--overlay", "Clearance",
                            "--width", "64", "--height", "48"))
    return 0


sys.exit(main())
