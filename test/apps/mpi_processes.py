# SPDX-FileCopyrightText: 2026 the throng authors
# SPDX-License-Identifier: MIT
"""Shared by tests under mpirun: how it is started, and which processes it has started."""
import os
import pathlib
import shutil

MPIRUN = ["mpirun", "--oversubscribe", *(["--allow-run-as-root"] if os.geteuid() == 0 else [])]
# A busy machine may need more than the second that Open MPI leaves between its two signals. One without ssh has no
# other machines to start ranks on, and Open MPI must not look for one.
# Ranks that wait give their core away: there are more of them than cores.
ENVIRONMENT = {**os.environ, "OMPI_MCA_odls_base_sigkill_timeout": "3", "OMPI_MCA_mpi_yield_when_idle": "1",
               **({} if shutil.which("ssh") else {"OMPI_MCA_plm_rsh_agent": "/bin/false"})}


def ranks_of(launcher):
    """The processes that a running mpirun has started, by rank."""
    found = {}
    for entry in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            parent = (entry / "stat").read_text().rpartition(")")[2].split()[1]
            names = (entry / "environ").read_bytes().split(b"\0")
        except OSError:
            continue
        for name in names:
            if int(parent) == launcher and name.startswith(b"OMPI_COMM_WORLD_RANK="):
                found[int(name.partition(b"=")[2])] = int(entry.name)
    return found


def ours(text):
    """The lines that the program has printed, not mpirun."""
    return [line for line in text.splitlines() if line.startswith("throng: ")]
