# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""A crowd that several processes under mpirun share: what one process does, bit for bit, for any number of them.

python3 ranks_run_test.py build/release/throng"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
TRIALS = pathlib.Path(__file__).resolve().parents[2] / "trials"
MPIRUN = ["mpirun", "--oversubscribe", *(["--allow-run-as-root"] if os.geteuid() == 0 else [])]
ENVIRONMENT = {**os.environ, "OMPI_MCA_mpi_yield_when_idle": "1",
               **({} if shutil.which("ssh") else {"OMPI_MCA_plm_rsh_agent": "/bin/false"})}
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


def test_crowds(folder):
    world = folder / "city.throng"
    assert run(1, "bake", "builtin:city,size=120,seed=3", "-o", world).returncode == 0
    for more in ([], ["--near", 20], ["--pushing"], ["--model", "caacd"]):
        words = ["run", world, "--avatars", 400, "--steps", 50, "--json", *more]
        files = [folder / "one.csv", folder / "one.rec"]
        one, _ = said(run(1, *words, "--threads", 2, "--trajectories", files[0], "--record", files[1]))
        for ranks, threads in ((2, 2), (3, 1), (4, 1), (7, 1)) if not more else ((3, 1),):
            other = [folder / "many.csv", folder / "many.rec"]
            many, whole = said(run(ranks, *words, "--threads", threads, "--trajectories", other[0], "--record", other[1]))
            assert many == one, (ranks, more, many, one)
            assert whole["ranks"] == ranks and whole["sent_bytes"] > 0, whole
            assert whole["most_avatars"] < 1.5 * 400 / ranks + 10, whole
            for a, b in zip(files, other):
                assert a.read_bytes() == b.read_bytes(), f"{ranks} ranks write another {b.name}"


def test_scenarios(folder):
    """With sources, queues, groups, lifts, doors that shut, and choices of the quickest exit."""
    for file, steps in (("nist/2_7_lift.toml", 900), ("nist/2_8_counter_flow.toml", 150), ("nist/2_9_group.toml", 400),
                        ("nist/4_1_shut_door.toml", 300), ("rimea/09_exits.toml", 100),
                        ("rimea/11_exit_choice.toml", 100)):
        trips = [folder / "one.csv", folder / "many.csv"]
        words = ["run", TRIALS / file, "--steps", steps, "--threads", 1, "--json", "--trips"]
        one, _ = said(run(1, *words, trips[0]))
        many, whole = said(run(3, *words, trips[1]))
        assert whole["ranks"] == 3 and many == one, (file, many, one)
        assert trips[0].read_bytes() == trips[1].read_bytes(), file


def test_refusals(folder):
    world = folder / "air.throng"
    assert run(1, "bake", "builtin:garage", "-o", world, "--fly").returncode == 0

    def refused(*words):
        done = run(2, "run", world, "--avatars", 20, "--steps", 5, *words)
        lines = [line for line in done.stderr.splitlines() if line.startswith("throng: ")]
        assert done.returncode == 2 and not done.stdout.strip() and len(lines) == 1, done.stdout + done.stderr
        return lines[0]

    assert "flies" in refused("--class", "flyer")
    assert "one process" in refused("--wander")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for test in (test_crowds, test_scenarios, test_refusals):
            (folder / test.__name__).mkdir()
            test(folder / test.__name__)
    print("equal crowds by 1, 2, 3, 4 and 7 ranks")


main()
