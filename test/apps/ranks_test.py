# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""A bake by several processes under mpirun: the bytes of one by one process, for any number of them, and after one
of them has died.

python3 ranks_test.py build/release/throng [--built-without-mpi]"""
import concurrent.futures
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from mpi_processes import ENVIRONMENT, MPIRUN, ours, ranks_of

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
MODEL = "builtin:city,size=300,seed=3"
OPTIONS = ["--zone", "25.6", "--json"]
SESSIONS = tempfile.TemporaryDirectory()  # of Open MPI: two that start at once may not share a folder
RECORD = 48  # bytes of the journal for each zone


def bake_words(world, model=MODEL, options=()):
    return [PROGRAM, "bake", model, "-o", world, *OPTIONS, *options]


def environment():
    return {**ENVIRONMENT, "TMPDIR": tempfile.mkdtemp(dir=SESSIONS.name)}


def run(words):
    return subprocess.run(words, capture_output=True, text=True, check=False, env=environment())


def content(world):
    return {str(file.relative_to(world)): file.read_bytes() for file in world.rglob("*") if file.is_file()}


def kill_a_rank(folder, rank, ranks, files=0, kind="tha", options=(), model=MODEL):
    """Bakes until some zones are done, or some files of a kind that is made after them, and kills one rank. Returns
    standard error and the zones in the journal. Open MPI stops rank 0 only after it has made all files: stop it here."""
    world = folder / "killed.throng"
    part = folder / "killed.throng.part"
    journal = part / "journal"
    words = bake_words(world, model, ["--threads", "1", *options])
    with subprocess.Popen([*MPIRUN, "-n", str(ranks), *words], env=environment(),
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        while process.poll() is None:
            if journal.exists() and journal.stat().st_size >= 5 * RECORD and \
                    len(list(part.glob(f"*.{kind}"))) >= files:
                killed, first = ranks_of(process.pid).get(rank), ranks_of(process.pid).get(0)
                os.kill(killed, signal.SIGKILL)
                if files and rank != 0:
                    os.kill(first, signal.SIGTERM)
                break
            time.sleep(0.0005)
        out, err = process.communicate(timeout=60)
        assert process.returncode != 0, "a rank was killed and mpirun does not say so"
        assert not world.exists() and not out.strip(), out
        assert journal.exists(), err
    return err, journal.stat().st_size // RECORD


def test_bytes(folder, reference):
    for ranks in (1, 2, 3):
        world = folder / f"by{ranks}.throng"
        done = run([*MPIRUN, "-n", str(ranks), *bake_words(world)])
        assert done.returncode == 0, done.stderr
        assert not ours(done.stderr), done.stderr
        report = json.loads(done.stdout)  # One object, from one rank.
        assert report["zones_reused"] == 0 and report["zones_baked"] == reference["report"]["zones_baked"]
        assert report["zones_relinked"] == report["zones"] == reference["report"]["zones"]
        assert report["walkable_area"] == reference["report"]["walkable_area"]
        assert content(world) == reference["content"], f"{ranks} ranks: other bytes than one process"
        again = run([*MPIRUN, "-n", str(ranks), *bake_words(world)])
        again_report = json.loads(again.stdout)
        assert again_report["zones_baked"] == again_report["zones_relinked"] == 0, again.stdout
        assert content(world) == reference["content"], f"{ranks} ranks: other bytes when all is reused"
        shutil.rmtree(world)


def test_death(folder, reference):
    total = reference["report"]["zones_baked"]
    for rank, ranks in ((1, 2), (0, 2), (2, 3)):
        err, finished = kill_a_rank(folder, rank, ranks)
        assert 5 <= finished < total, f"{finished} of {total} zones: nothing was left to kill"
        said = ours(err)
        assert said and all("another rank has died" in line and "goes on from there" in line for line in said), err
        assert len(said) <= 2 and all(f"rank {rank} of {ranks}" not in line for line in said), err
        world = folder / "killed.throng"
        # One process resumes, or several.
        words = bake_words(world) if rank == 0 else [*MPIRUN, "-n", "2", *bake_words(world)]
        done = run(words)
        assert done.returncode == 0, done.stderr
        assert json.loads(done.stdout)["zones_reused"] >= finished, done.stdout
        assert content(world) == reference["content"], "other bytes than undisturbed"
        assert not (folder / "killed.throng.part").exists()
        shutil.rmtree(world)


def test_air(folder):
    """The air is made after the ground, by all ranks."""
    fly = ["--fly", "--air", "0.4"]
    world = folder / "air.throng"
    done = run(bake_words(world, options=fly))
    assert done.returncode == 0, done.stderr
    report, one = json.loads(done.stdout), content(world)
    assert report["air_zones"] > 20, report
    shutil.rmtree(world)
    done = run([*MPIRUN, "-n", "2", *bake_words(world, options=fly)])
    assert done.returncode == 0, done.stderr
    assert content(world) == one, "other bytes of air than by one process"
    shutil.rmtree(world)
    for rank in (1, 0):
        err, finished = kill_a_rank(folder, rank, 2, files=3, options=fly)
        assert finished == report["zones_baked"], f"{finished} zones: the air was not yet due"
        said = ours(err)
        assert all("another rank has died" in line and "goes on from there" in line for line in said), err
        assert rank == 0 or said, err
        done = run(bake_words(folder / "killed.throng", options=fly))
        assert done.returncode == 0, done.stderr
        assert json.loads(done.stdout)["zones_reused"] == finished, done.stdout
        assert content(folder / "killed.throng") == one, "other bytes of air than undisturbed"
        shutil.rmtree(folder / "killed.throng")


def test_graph(folder, reference):
    """Regions and links are made last, by all ranks."""
    total = reference["report"]["zones_baked"]
    for rank, kind in ((1, "thr"), (0, "thr"), (1, "thl"), (0, "thl")):
        err, finished = kill_a_rank(folder, rank, 2, files=3, kind=kind)
        assert finished == total, f"{finished} zones: the graph was not yet due"
        said = ours(err)
        assert all("another rank has died" in line and "goes on from there" in line for line in said), err
        assert rank == 0 or said, err
        world = folder / "killed.throng"
        words = bake_words(world) if rank == 0 else [*MPIRUN, "-n", "2", *bake_words(world)]
        report = json.loads(run(words).stdout)
        assert report["zones_reused"] == total, report
        assert report["zones_relinked"] <= total - (3 if kind == "thl" else 0), report
        assert content(world) == reference["content"], "other bytes than undisturbed"
        shutil.rmtree(world)


def kill_amid_nodes(world, rank, ranks, options):
    """Bakes until some zones' nodes are made, kills one rank. Returns standard error, or None if all were made before."""
    part = world / "nodes.part"
    words = bake_words(world, options=["--threads", "1", *options])
    with subprocess.Popen([*MPIRUN, "-n", str(ranks), *words], env=environment(),
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        killed = False
        while process.poll() is None:
            if not killed and len(list(part.glob("*.thn"))) > 3:
                victim = ranks_of(process.pid).get(rank)
                if victim is not None:
                    os.kill(victim, signal.SIGKILL)
                    killed = True
            time.sleep(0.0005)
        out, err = process.communicate(timeout=60)
    return err if process.returncode != 0 and not out.strip() else None


def test_nodes(folder):
    """Batches of zones are assigned to all ranks."""
    options = ["--nodes", "--node-memory", "1", "--fly"]  # MiB: many batches even of so small a world
    world = folder / "nodes.throng"
    done = run(bake_words(world, options=options))
    assert done.returncode == 0, done.stderr
    report, one = json.loads(done.stdout), content(world)
    made = report["node_zones_made"]
    assert made > 100 and report["node_zones_reused"] == 0, report
    assert sum(name.endswith(".thg") for name in one) > 100, "there are no links between the air and the nodes"
    shutil.rmtree(world)
    same = ("nodes", "node_arcs", "node_bytes", "node_zones_made", "node_zones_reused")
    for ranks in (2, 3):
        words = [*MPIRUN, "-n", str(ranks), *bake_words(world, options=options)]
        done = run(words)
        assert done.returncode == 0 and not ours(done.stderr), done.stderr
        assert [json.loads(done.stdout)[key] for key in same] == [report[key] for key in same], done.stdout
        assert content(world) == one, f"{ranks} ranks: other nodes than one process"
        again = json.loads(run(words).stdout)
        assert (again["node_zones_made"], again["node_zones_reused"]) == (0, made), again
        assert content(world) == one, f"{ranks} ranks: other nodes when all are reused"
        shutil.rmtree(world)
    resumed = 0
    for rank, ranks in ((1, 2), (0, 2), (2, 3)):
        err = kill_amid_nodes(world, rank, ranks, options)
        if err is not None:
            said = ours(err)
            assert all("goes on from there" in line and "it has no nodes yet" in line for line in said), err
            assert len(said) <= 2 and all(f"rank {rank} of {ranks}" not in line for line in said), err
        words = bake_words(world, options=options) if rank == 0 else [*MPIRUN, "-n", "2", *bake_words(world, options=options)]
        done = run(words)
        assert done.returncode == 0, done.stderr
        resumed += err is not None and json.loads(done.stdout)["node_zones_reused"] > 0
        assert content(world) == one, "other nodes than undisturbed"
        assert not (world / "nodes.part").exists()
        shutil.rmtree(world)
    assert resumed > 0, f"{resumed} of 3 bakes were killed amid their nodes and gone on with"


def test_blocks(folder):
    """With --memory no rank holds the scene: blocks of zones, and batches of nodes, are assigned."""
    model, options = "builtin:landscape,size=300", ["--cell", "0.25", "--nodes", "--fly"]
    world = folder / "blocks.throng"
    done = run(bake_words(world, model, options))
    assert done.returncode == 0, done.stderr
    report, one = json.loads(done.stdout), content(world)
    assert report["zones"] >= 100 and report["air_zones"] >= 100, report
    shutil.rmtree(world)
    bounded = [*options, "--memory", "40"]
    same = ("zones", "triangles", "walkable_area", "air_zones", "nodes", "node_arcs")
    for ranks in (1, 2, 3):
        words = [*MPIRUN, "-n", str(ranks), *bake_words(world, model, bounded)]
        done = run(words)
        assert done.returncode == 0 and not ours(done.stderr), done.stderr
        assert [json.loads(done.stdout)[key] for key in same] == [report[key] for key in same], done.stdout
        assert content(world) == one, f"{ranks} ranks: other bytes in blocks than of the whole scene"
        again = json.loads(run(words).stdout)
        assert again["zones_baked"] == again["zones_relinked"] == again["node_zones_made"] == 0, again
        assert content(world) == one, f"{ranks} ranks: other bytes when all is reused"
        shutil.rmtree(world)
    for rank, ranks in ((1, 2), (0, 2), (2, 3)):
        err, finished = kill_a_rank(folder, rank, ranks, options=bounded, model=model)
        said = ours(err)
        assert said and all("another rank has died" in line and "goes on from there" in line for line in said), err
        killed = folder / "killed.throng"
        words = bake_words(killed, model, bounded)
        done = run(words if rank == 0 else [*MPIRUN, "-n", "2", *words])
        assert done.returncode == 0, done.stderr
        assert json.loads(done.stdout)["zones_reused"] >= finished, done.stdout
        assert content(killed) == one, "other bytes in blocks than undisturbed"
        shutil.rmtree(killed)


def test_refusals(folder):
    world = folder / "refused.throng"

    def refused(*words):
        done = run([*MPIRUN, *words])
        assert done.returncode != 0 and not done.stdout.strip(), done.stdout
        assert not world.exists() and not (folder / "refused.throng.part").exists()
        assert len(ours(done.stderr)) == 1, done.stderr
        return ours(done.stderr)[0]

    missing = folder / "missing.obj"
    here = bake_words(world)
    assert "missing.obj" in refused("-n", "3", *bake_words(world, missing))
    assert "rank 1: " in refused("-n", "1", *here, ":", "-n", "1", *bake_words(world, missing))
    assert "cell" in refused("-n", "2", *bake_words(world, options=["--cell", "0"]))
    for option in ("--off-mesh-links", "--classes"):
        assert "missing.toml" in refused("-n", "3", *bake_words(world, options=[option, "missing.toml"]))
    other = bake_words(world, "builtin:city,size=300,seed=4")
    assert "rank 2 has read another scene" in refused("-n", "2", *here, ":", "-n", "1", *other)
    (folder / "refused.throng").write_text("not a world")
    done = run([*MPIRUN, "-n", "2", *here])
    assert done.returncode != 0 and "is not a baked world" in ours(done.stderr)[0], done.stderr


def test_without_mpi(folder):
    """Processes without MPI would all write the same folder."""
    for rank in range(2):
        ENVIRONMENT.update(OMPI_COMM_WORLD_SIZE="2", OMPI_COMM_WORLD_RANK=str(rank))
        done = run(bake_words(folder / "w.throng"))
        assert done.returncode != 0 and not done.stdout and not list(folder.iterdir())
        assert ["built without MPI" in line for line in ours(done.stderr)] == [True] * (1 - rank), done.stderr


def test_all(folder):
    """Most of the time is Open MPI's, which waits between its two signals: the parts run at once."""
    started_in = folder / "started_in"  # Nothing may be written where the ranks were started.
    started_in.mkdir()
    os.chdir(started_in)
    world = folder / "reference.throng"
    done = run(bake_words(world))
    assert done.returncode == 0, done.stderr
    reference = {"report": json.loads(done.stdout), "content": content(world)}
    parts = {test_bytes: [reference], test_death: [reference], test_air: [], test_graph: [reference], test_nodes: [],
             test_blocks: [], test_refusals: []}
    with concurrent.futures.ThreadPoolExecutor(3) as at_once:
        for part in parts:
            (folder / part.__name__).mkdir()
        futures = [at_once.submit(part, folder / part.__name__, *more) for part, more in parts.items()]
        for future in futures:
            future.result()
    assert not list(started_in.iterdir()), list(started_in.iterdir())


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if "--built-without-mpi" in sys.argv:
            test_without_mpi(folder)
        else:
            test_all(folder)
            print("equal bytes by 1, 2 and 3 ranks, and after each death")


main()
