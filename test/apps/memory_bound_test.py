# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""--memory and --part of throng path, throng run and throng bake: bounds are kept, answers are those without a bound.

memory_bound_test.py THRONG"""
import json
import os
import pathlib
import sys
import tempfile

MIB = 1 << 20


def run(throng, *arguments):
    """Exit code, standard output and error, and the peak of memory [bytes]."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        actions = [(os.POSIX_SPAWN_DUP2, out.fileno(), 1), (os.POSIX_SPAWN_DUP2, err.fileno(), 2)]
        process = os.posix_spawn(throng, [throng, *map(str, arguments)], os.environ, file_actions=actions)
        _, status, used = os.wait4(process, 0)
        out.seek(0)
        err.seek(0)
        return os.waitstatus_to_exitcode(status), out.read(), err.read(), used.ru_maxrss * 1024


def check_path(throng, world):
    for end in ("300,1,260", "640,1,500", "700,1,90"):
        query = ("path", world, "--from", "210,1,160", "--to", end, "--tolerance", 5, "--json")
        code, free, err, peak = run(throng, *query)
        assert code == 0, err
        code, bounded, err, small = run(throng, *query, "--memory", 48)
        assert code == 0, err
        assert small <= 48 * MIB, f"{end}: {small / MIB:.1f} MiB instead of 48"
        assert peak > small, f"{end}: {peak / MIB:.1f} MiB without a bound, {small / MIB:.1f} with one"
        a, b = json.loads(free), json.loads(bounded)
        assert abs(a["length"] - b["length"]) <= 1e-6 * a["length"], (end, a["length"], b["length"])
        print(f"memory_bound_test: to {end}: {a['length']:.1f} m, {peak / MIB:.0f} MiB, {small / MIB:.0f} with --memory 48")
    code, out, err, _ = run(throng, *query[:-1], "--memory", 48, "--nodes")
    assert code == 2 and "--memory" in err and not out, (code, out, err)
    code, out, err, _ = run(throng, *query[:-1], "--memory", 8)
    assert code == 2 and "40" in err, (code, out, err)


def check_run(throng, world, folder):
    part = ("--part", "200,200,280,280")
    crowd = ("run", world, "--avatars", 500, "--steps", 60, "--json")
    code, out, err, all_of_it = run(throng, *crowd, "--near", 60)
    assert code == 0, err
    recording = folder / "walk.replay"
    code, out, err, peak = run(throng, *crowd, *part, "--memory", 64, "--record", recording)
    assert code == 0, err
    report = json.loads(out)
    assert report["overlaps"] == 0 and report["wall_entries"] == 0 and report["avatars"] == 500, report
    assert peak <= 64 * MIB < all_of_it, (peak / MIB, all_of_it / MIB)
    print(f"memory_bound_test: 500 avatars: {all_of_it / MIB:.0f} MiB, {peak / MIB:.0f} in a district with --memory 64")
    for threads in (1, 2):
        code, out, err, _ = run(throng, "replay", recording, "--check", "--threads", threads)
        assert code == 0, (out, err)
    code, out, err, _ = run(throng, *crowd, *part, "--wander", "--record", recording)
    assert code == 0, err
    code, out, err, _ = run(throng, "replay", recording, "--check")
    assert code == 0, (out, err)
    # Too little is said before anything is written.
    trajectories = folder / "walk.csv"
    code, out, err, _ = run(throng, *crowd, "--near", 60, "--memory", 40, "--trajectories", trajectories)
    assert code == 2 and "--part" in err and "--memory" in err and not trajectories.exists(), (code, out, err)
    code, out, err, _ = run(throng, *crowd, "--part", "5000,0,6000,10")
    assert code == 2 and "no ground" in err, (code, out, err)
    code, out, err, _ = run(throng, *crowd, "--part", "5000,0,6000")
    assert code == 2 and "--part" in err, (code, out, err)


def check_scenario(throng, world, folder):
    text = f"""world = "{world}"
part = [200, 200, 280, 280]
seconds = 6
[[area]]
name = "street"
box = [205, 205, 275, 275]
[[profile]]
name = "adult"
[[journey]]
name = "stroll"
repeat = true
stages = [{{ random_point = "street" }}]
[[source]]
name = "people"
area = "street"
profile = "adult"
journey = "stroll"
count = 60
"""
    file = folder / "part.toml"
    file.write_text(text, encoding="ascii")
    recording = folder / "part.replay"
    code, out, err, peak = run(throng, "run", file, "--record", recording)
    assert code == 0, err
    assert peak < 90 * MIB, peak / MIB
    code, out, err, _ = run(throng, "replay", recording, "--check")
    assert code == 0, (out, err)
    file.write_text(text.replace(f'world = "{world}"', '[builtin]\nname = "garage"\n').replace("part = [200, 200, 280, 280]\n", "", 1)
                    .replace("[builtin]", "part = [0, 0, 1, 1]\n[builtin]"), encoding="ascii")
    code, out, err, _ = run(throng, "run", file)
    assert code == 2 and "part" in err, (code, out, err)
    code, out, err, _ = run(throng, "run", file, "--part", "0,0,1,1")
    assert code == 2 and "--part" in err, (code, out, err)


def files(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def check_files(throng, folder):
    """Many files, each of one place: what was read of the others is on disk. Before this process takes memory, which a child's peak includes."""
    names = []
    for n in range(60):
        names.append(folder / f"place{n}.obj")
        with open(names[-1], "w", encoding="ascii") as file:
            for t in range(4000):
                x, z = 300 * (n % 8) + t % 64, 300 * (n // 8) + t // 64
                file.write(f"v {x} 0 {z}\nv {x + 1} 0 {z}\nv {x + 1} 0 {z + 1}\nv {x} 0 {z + 1}\nf -1 -2 -3\nf -1 -3 -4\n")
    code, out, err, _ = run(throng, "bake", *names, "--cell", 1, "--memory", 40, "-o", folder / "places.throng", "--json")
    assert code == 0, err
    report = json.loads(out)
    print(f"memory_bound_test: 60 files are read within {report['peak_bytes_read'] / MIB:.0f} MiB")
    assert report["peak_bytes_read"] <= 40 * MIB and report["zones"] >= 60, out


def check_bake(throng, folder):
    large = ("bake", "builtin:landscape,size=1000", "--cell", 0.5, "--fly")
    code, _, err, peak = run(throng, *large, "-o", folder / "large.throng")
    assert code == 0, err
    code, _, err, least = run(throng, *large, "--memory", 100, "-o", folder / "bounded.throng")
    assert code == 0, err
    print(f"memory_bound_test: a bake with air: {peak / MIB:.0f} MiB, {least / MIB:.0f} with --memory 100")
    assert least < 0.7 * peak and least <= 100 * MIB, (peak, least)
    assert files(folder / "bounded.throng") == files(folder / "large.throng")
    scene = ("bake", "builtin:landscape,size=300", "--cell", 0.5, "--fly")
    code, _, err, _ = run(throng, *scene, "--nodes", "-o", folder / "whole.throng")
    assert code == 0, err
    code, _, err, _ = run(throng, *scene, "--nodes", "--memory", 60, "-o", folder / "small.throng")
    assert code == 0, err
    whole = files(folder / "whole.throng")
    assert files(folder / "small.throng") == whole
    # Two halves, one of them within a bound, joined; then nodes of all.
    code, _, err, _ = run(throng, *scene, "--part", "0,0,150,300", "--memory", 64, "-o", folder / "west.throng")
    assert code == 0, err
    code, _, err, _ = run(throng, *scene, "--part", "150,0,300,300", "-o", folder / "east.throng")
    assert code == 0, err
    code, _, err, _ = run(throng, "join", folder / "west.throng", folder / "east.throng", "-o", folder / "joined.throng")
    assert code == 0, err
    ground = {name: data for name, data in whole.items() if not name.startswith("nodes")}
    assert files(folder / "joined.throng") == ground
    assert not list(folder.glob("*.tmp")) and not list(folder.glob("*.part")), list(folder.iterdir())
    # What cannot be done is said, and the world stays.
    cube = folder / "cube.throng"
    code, _, err, _ = run(throng, "bake", "builtin:cube", "--memory", 64, "-o", cube)
    assert code == 0, err
    for arguments, word in (((*scene, "--part", "0,0,9,9", "--nodes"), "--part"), ((*scene, "--memory", 8), "--memory"),
                            ((*scene, "--part", "900,900,999,999"), "no triangle"),
                            (("join", folder / "west.throng", cube), "join parts of one scene")):
        code, out, err, _ = run(throng, *arguments, "-o", folder / "joined.throng")
        assert code == 2 and word in err and not out, (arguments, code, out, err)
        assert files(folder / "joined.throng") == ground


def main():
    throng = sys.argv[1]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        world = folder / "city.throng"
        check_files(throng, folder)
        code, _, err, _ = run(throng, "bake", "builtin:city,size=800", "--cell", 0.2, "-o", world)
        assert code == 0, err
        check_path(throng, world)
        check_run(throng, world, folder)
        check_scenario(throng, world, folder)
        check_bake(throng, folder)
    return 0


sys.exit(main())
