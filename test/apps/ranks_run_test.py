# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""A crowd that several processes under mpirun share: what one process does, bit for bit, for any number of them.

python3 ranks_run_test.py build/release/throng [KILLS]
Without KILLS: few ranks, scenarios and kills, as the tests of each change do; ranks that wait keep other tests waiting."""
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

from mpi_processes import ENVIRONMENT, MPIRUN, ours, ranks_of

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
TRIALS = pathlib.Path(__file__).resolve().parents[2] / "trials"
# Of a run by several processes: what differs, and what only they say.
OWN = ("threads", "crowd_bytes", "peak_bytes", "ranks", "most_avatars", "sent_bytes")


def run(ranks, *words):
    launch = [*MPIRUN, "-n", str(ranks)] if ranks > 1 else []
    return subprocess.run([*launch, PROGRAM, *map(str, words)], capture_output=True, text=True, check=False,
                          env=ENVIRONMENT)


def said(done):
    """The report, without times."""
    assert done.returncode == 0, done.stderr + done.stdout
    report = json.loads(done.stdout)
    return {key: value for key, value in report.items()
            if key not in OWN and not key.startswith(("seconds_", "ns_"))}, report


def test_crowds(folder, whole):
    world = folder / "city.throng"
    assert run(1, "bake", "builtin:city,size=120,seed=3", "-o", world).returncode == 0
    settings = ([], ["--near", 20], ["--pushing"], ["--model", "caacd"]) if whole else ([], ["--model", "caacd"])
    for more in settings:
        words = ["run", world, "--avatars", 400, "--steps", 50, "--json", *more]
        files = [folder / "one.csv", folder / "one.rec"]
        one, _ = said(run(1, *words, "--threads", 2, "--trajectories", files[0], "--record", files[1]))
        counts = ((2, 2), (3, 1), (3, 2), (4, 1), (7, 1)) if whole else ((2, 1), (3, 1))
        for ranks, threads in counts if not more else ((2, 1),):
            other = [folder / "many.csv", folder / "many.rec"]
            many, report = said(run(ranks, *words, "--threads", threads, "--trajectories", other[0], "--record", other[1]))
            assert many == one, (ranks, more, many, one)
            assert report["ranks"] == ranks and report["sent_bytes"] > 0, report
            assert report["most_avatars"] < 1.5 * 400 / ranks + 10, report
            for a, b in zip(files, other):
                assert a.read_bytes() == b.read_bytes(), f"{ranks} ranks write another {b.name}"


def test_scenarios(folder, whole):
    """With sources, queues, groups, lifts, doors that shut, and choices of the quickest exit."""
    few = ("nist/2_9_group.toml", "nist/4_1_shut_door.toml", "rimea/11_exit_choice.toml")
    for file, steps in (("nist/2_7_lift.toml", 900), ("nist/2_8_counter_flow.toml", 150), ("nist/2_9_group.toml", 400),
                        ("nist/4_1_shut_door.toml", 300), ("rimea/09_exits.toml", 100),
                        ("rimea/11_exit_choice.toml", 100)):
        if not whole and file not in few:
            continue
        ranks = 3 if whole else 2
        trips = [folder / "one.csv", folder / "many.csv"]
        words = ["run", TRIALS / file, "--steps", steps, "--threads", 1, "--json", "--trips"]
        one, _ = said(run(1, *words, trips[0]))
        many, report = said(run(ranks, *words, trips[1]))
        assert report["ranks"] == ranks and many == one, (file, many, one)
        assert trips[0].read_bytes() == trips[1].read_bytes(), file


def kill_and_resume(folder, words, one, seed):
    """A rank dies at a random moment; the run goes on with another number of ranks. True if it was killed amid steps."""
    chance = random.Random(seed)
    ranks, file = chance.choice((2, 3)), folder / f"{seed}.checkpoint"
    with subprocess.Popen([*MPIRUN, "-n", str(ranks), PROGRAM, *map(str, words), "--checkpoint", file, "--checkpoint-every",
                           "3"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT) as process:
        deadline = time.monotonic() + 60
        while not file.exists() and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.01)
        time.sleep(chance.uniform(0, 0.5))
        victim = ranks_of(process.pid).get(chance.randrange(ranks))
        if victim is not None and process.poll() is None:
            os.kill(victim, signal.SIGKILL)
        out, err = process.communicate(timeout=120)
    if out.strip():  # It was done before: rank 0 has printed.
        assert json.loads(out)["state_hash"] == one["state_hash"], out
        return False
    lines = set(ours(err))
    assert lines and all("ended in step" in line and f"--resume {file}" in line for line in lines), err
    again, _ = said(run(chance.choice((1, 2, 4)), *words, "--resume", file))
    for key in ("state_hash", "steps", "overlaps", "wall_entries"):
        assert key == "steps" or again[key] == one[key], (seed, key, again, one)
    return True


def test_checkpoints(folder, kills):
    world = folder / "city.throng"
    assert run(1, "bake", "builtin:city,size=120,seed=3", "-o", world).returncode == 0
    words = ["run", world, "--avatars", 300, "--steps", 400, "--near", 30, "--threads", 1, "--json"]
    one, _ = said(run(1, *words))
    killed = sum(kill_and_resume(folder, words, one, seed) for seed in range(1, kills + 1))
    assert killed >= kills / 4, f"only {killed} of {kills} were killed amid steps"
    # A checkpoint of one process, and what is refused.
    file = folder / "alone.checkpoint"
    short = [*words[:5], 60, *words[6:]]
    assert run(1, *short, "--checkpoint", file, "--checkpoint-every", 50).returncode == 0
    again, _ = said(run(3, *words, "--resume", file))
    assert again["state_hash"] == one["state_hash"]
    for change, word in ((["--seed", 2], "seed"), (["--near", 31], "near"), (["--avatars", 299], "avatars")):
        done = run(1, *words, *change, "--resume", file)
        assert done.returncode == 2 and word in done.stderr and not done.stdout, done.stderr
    bytes_of = file.read_bytes()
    for broken in (b"", bytes_of[:100], bytes_of[:-1], b"x" + bytes_of, bytes_of[:3000] + b"\xff" + bytes_of[3001:]):
        (folder / "broken").write_bytes(broken)
        done = run(1, *words, "--resume", folder / "broken")
        assert done.returncode == 2 and "broken" in done.stderr + "crowd: broken", (broken[:40], done.stderr)
        assert len(ours(done.stderr)) == 1, done.stderr
    return killed


def test_refusals(folder):
    world = folder / "air.throng"
    assert run(1, "bake", "builtin:garage", "-o", world, "--fly").returncode == 0

    def refused(*words):
        done = run(2, "run", world, "--avatars", 20, "--steps", 5, *words)
        lines = ours(done.stderr)
        assert done.returncode == 2 and not done.stdout.strip() and len(lines) == 1, done.stdout + done.stderr
        return lines[0]

    assert "flies" in refused("--class", "flyer")
    assert "one process" in refused("--wander")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        whole = len(sys.argv) > 2
        kills = int(sys.argv[2]) if whole else 2
        tests = {test_crowds: [whole], test_scenarios: [whole], test_checkpoints: [kills], test_refusals: []}
        for test, more in tests.items():
            (folder / test.__name__).mkdir()
            test(folder / test.__name__, *more)
    print(f"equal crowds by any number of ranks, and after {kills} kills")


main()
