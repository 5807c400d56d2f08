#!/usr/bin/env python3
"""Lets `graze run --slurm` compute a study by a cluster on this machine, and disturbs it: nodes are lost, tasks put back into
the queue, cancelled, ended by signals. The results are the same each time, to the last byte.

usage: slurm.py GRAZE
"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

from cluster import Cluster, wait_until

GRAZE = str(pathlib.Path(sys.argv[1]).resolve())
PARTS = 3

# The sweep takes three seconds of one processor. A distance of recurrence that is never reached makes each point do all its cycles.
STUDY = """
name = "cluster"
model = "impact-oscillator"
set = { omega = 2.75 }
[runs.sweep]
kind = "sweep"
vary = { sigma = { from = 0, to = 0.2, points = 2 }, omega = { from = 2.2, to = 3, points = 24 } }
cycles = 4000
chaos_cycles = 4000
recurrence = 1e-13
[runs.orbit]
kind = "orbit"
[runs.after]
kind = "sweep"
start = { run = "sweep" }
vary = { omega = { from = 2.2, to = 2.3, points = 4 }, sigma = { from = 0, to = 0.4, points = 4 } }
[pictures.diagram]
run = "sweep"
"""


class Cases:
    def __init__(self, cluster, folder):
        self.cluster, self.folder = cluster, folder
        (folder / "study.toml").write_text(STUDY)
        self.finish(self.graze("run", "study.toml", "--output", "whole", "--no-pictures"))
        self.expected = self.results("whole")

    def graze(self, *words):
        return subprocess.Popen([GRAZE, *words], cwd=self.folder, env=self.cluster.environment, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def by_slurm(self, name, *words):
        return self.graze("run", "study.toml", "--output", name, "--slurm", str(PARTS), *words)

    @staticmethod
    def finish(process, code=0):
        """@return what it prints and says"""
        out, err = process.communicate(timeout=60)
        assert process.returncode == code, f"exit code {process.returncode}:\n{out}{err}"
        return out + err

    def results(self, name):
        text = ""
        for run in ("sweep", "orbit", "after"):
            for what in ("points", "samples") if run != "orbit" else ("points", "multipliers"):
                text += self.finish(self.graze("export", name, "--run", run, "--what", what, "--format", "csv"))
        return text

    def same(self, name):
        assert self.results(name) == self.expected, f"other results in {name}"
        assert (self.folder / name / "diagram.png").exists()

    def running(self, name):
        """The first task that computes for this folder, and its node, as soon as it has written points."""
        def found():
            for task, state, node in self.cluster.tasks():
                number = task.partition("_")[2]
                file = self.folder / name / f"parts/{number}-of-{PARTS}.sqlite"
                if state == "RUNNING" and file.exists() and file.with_name(file.name + "-wal").exists():
                    return task, node
            return None
        return wait_until(found, "no task has begun")

    def empty(self):
        wait_until(lambda: not self.cluster.tasks(), "SLURM's queue does not become empty")

    # The cases

    def waits_and_merges(self):
        name = "it's 100% \"#1\""  # a name that shells and SLURM could misread
        said = self.finish(self.by_slurm(name, "--", "--comment", "two words", "--cpus-per-task=1"))
        self.same(name)
        assert said.count(f"all {PARTS} parts") == 2, said  # `after` waits for all points of `sweep`
        again = self.finish(self.by_slurm(name))
        assert "job" not in again, again

    def returns_at_once(self):
        said = self.finish(self.by_slurm("later", "--no-wait"))
        assert "graze merge later" in said, said
        self.empty()
        said = self.finish(self.graze("merge", "later"), 3)
        assert "run 'after'" in said, said
        assert "job" in self.finish(self.by_slurm("later", "--no-wait"))
        self.empty()
        self.finish(self.graze("merge", "later"))
        self.same("later")

    def goes_on_after_signals(self):
        process = self.by_slurm("signals")
        task, _ = self.running("signals")
        process.send_signal(signal.SIGINT)
        assert "the jobs go on" in self.finish(process, 130)
        self.cluster.run("scancel", "--batch", "--signal=TERM", task)  # as at a time limit
        wait_until(lambda: task not in [one[0] for one in self.cluster.tasks()], "the task does not end")
        number = task.partition("_")[2]
        assert "interrupted" in (self.folder / f"signals/parts/{number}-of-{PARTS}.log").read_text()
        said = self.finish(self.by_slurm("signals"))
        assert f"part {number} of {PARTS}" in said and "queue already" in said, said
        self.same("signals")

    def says_what_is_missing(self):
        process = self.by_slurm("cancelled")
        task, _ = self.running("cancelled")
        self.cluster.run("scancel", task)
        said = self.finish(process, 3)
        assert "points are missing" in said and "CANCELLED" in said, said
        self.finish(self.by_slurm("cancelled"))
        self.same("cancelled")

    def goes_on_when_requeued(self):
        process = self.by_slurm("requeued")
        task, _ = self.running("requeued")
        self.cluster.run("scontrol", "requeue", task)
        self.finish(process)
        self.same("requeued")
        log = (self.folder / f"requeued/parts/{task.partition('_')[2]}-of-{PARTS}.log").read_text()
        assert "interrupted" in log, log

    def outlives_a_node(self):
        process = self.by_slurm("lost")
        _, node = self.running("lost")
        self.cluster.lose_node(node)
        self.finish(process)
        self.same("lost")


def main():
    if os.geteuid() != 0:
        sys.exit("slurm.py: slurmd has to be started by root")
    begun = time.monotonic()
    with Cluster(["n1", "n2"]) as cluster, tempfile.TemporaryDirectory(prefix="graze-slurm-") as folder:
        print(f"a cluster of two nodes, {time.monotonic() - begun:.1f} s")
        cases = Cases(cluster, pathlib.Path(folder))
        for case in (cases.waits_and_merges, cases.returns_at_once, cases.goes_on_after_signals, cases.says_what_is_missing,
                     cases.goes_on_when_requeued, cases.outlives_a_node):
            at = time.monotonic()
            try:
                case()
            except BaseException:
                cluster.tell()
                for log in sorted(pathlib.Path(folder).glob("*/parts/*.log")):
                    print(f"-- {log}", log.read_text(errors="replace")[-1000:], sep="\n")
                raise
            print(f"{case.__name__}: passed, {time.monotonic() - at:.1f} s", flush=True)
    print(f"all cases passed in {time.monotonic() - begun:.0f} s")


if __name__ == "__main__":
    # So that all processes end if this one is to end.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    main()
