#!/usr/bin/env python3
"""Lets `srun graze run` compute a study by a cluster on this machine: its processes work together by MPI where they can, are
refused where they cannot, and the script of a batch job computes alone.

usage: srun.py GRAZE
"""
import pathlib
import signal
import subprocess
import sys
import tempfile

from cluster import Cluster

GRAZE = str(pathlib.Path(sys.argv[1]).resolve())
STUDY = """
name = "srun"
model = "impact-oscillator"
[runs.sweep]
kind = "sweep"
vary = { omega = { from = 2.7, to = 2.9, points = 20 }, sigma = { from = 1.2, to = 1.3, points = 20 } }
[runs.orbit]
kind = "orbit"
set = { omega = 4 }
from = { x = -0.07 }
"""


def main():
    with tempfile.TemporaryDirectory() as name, Cluster(["one"]) as cluster:
        folder = pathlib.Path(name)
        (folder / "study.toml").write_text(STUDY)

        def done(*words):
            return subprocess.run(words, cwd=folder, env=cluster.environment, text=True, capture_output=True, timeout=120)

        def computed(output, *before):
            ended = done(*before, GRAZE, "run", "study.toml", "--no-pictures", "--output", output)
            assert ended.returncode == 0, (output, ended.stdout, ended.stderr)
            assert ended.stdout.count("done") == 2, (output, ended.stdout)  # one table
            return [done(GRAZE, "export", output, "--run", run, "--format", "csv").stdout for run in ("sweep", "orbit")]

        alone = computed("alone")
        assert computed("together", "srun", "--mpi=pmix", "--ntasks=3", "--overcommit") == alone
        refused = done("srun", "--mpi=none", "--ntasks=3", "--overcommit", GRAZE, "run", "study.toml", "--output", "apart")
        assert refused.returncode == 2 and refused.stderr.count("srun --mpi=pmix") == 1, refused
        assert not (folder / "apart").exists()

        (folder / "job.sh").write_text(f"#!/bin/sh\nexec {GRAZE} run study.toml --no-pictures --output job\n")
        job = done("sbatch", "--wait", "--ntasks=3", "--overcommit", "--output=job.log", "job.sh")
        assert job.returncode == 0 and (folder / "job.log").read_text().count("done") == 2, (job, (folder / "job.log").read_text())
    print("srun: passed")


if __name__ == "__main__":
    # So that all processes end if this one is to end.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    main()
