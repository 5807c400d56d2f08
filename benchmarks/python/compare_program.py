"""The same study by the program and by graze.run_study: a sweep and a branch. Both write the same result file, so that the
times should be equal: 3 % are allowed, but for the start of the processes. Times are those of the processor, which other
programs disturb less.

usage: PYTHONPATH=build/release/python python3 benchmarks/python/compare_program.py [--quick]

The program is that of the same build, or that of the variable GRAZE.
"""
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

import graze

STUDY = """
name = "speed"
model = "impact-oscillator"

[runs.sweep]
kind = "sweep"
cycles = 150
vary = {{ omega = {{ from = 2.4, to = 3.4, points = {points} }} }}

[runs.rest]
kind = "orbit"
set = {{ omega = 4 }}
from = {{ x = -0.07 }}

[runs.branch]
kind = "continue"
start = {{ run = "rest" }}
along = {{ omega = [2.2, 4.5] }}
direction = "down"
step = {{ first = {step}, largest = {step} }}
steps = {steps}
"""


def program() -> str:
    path = os.environ.get("GRAZE", str(pathlib.Path(graze.__file__).parents[2] / "bin/graze"))
    if not pathlib.Path(path).exists():
        sys.exit("the program graze is not built")
    return path


def seconds_since(begun, who) -> float:
    now = resource.getrusage(who)
    return now.ru_utime + now.ru_stime - begun.ru_utime - begun.ru_stime


def by_program(study: pathlib.Path, folder: pathlib.Path) -> float:
    begun = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([program(), "run", str(study), "--output", str(folder), "--jobs", "1", "--no-pictures"], check=True, capture_output=True)
    return seconds_since(begun, resource.RUSAGE_CHILDREN)


def by_module(study: pathlib.Path, folder: pathlib.Path) -> float:
    begun = resource.getrusage(resource.RUSAGE_SELF)
    graze.run_study(str(study), output=str(folder), threads=1)
    return seconds_since(begun, resource.RUSAGE_SELF)


def main() -> None:
    quick = "--quick" in sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        study = folder / "speed.toml"
        study.write_text(STUDY.format(points=20 if quick else 600, step=0.05 if quick else 0.001,
                                      steps=50 if quick else 2500))
        times = {"the program": [], "graze.run_study": []}
        for turn in range(1 if quick else 3):
            times["the program"].append(by_program(study, folder / f"program{turn}"))
            times["graze.run_study"].append(by_module(study, folder / f"module{turn}"))
        one, other = (graze.read_results(folder / f"{what}0") for what in ("program", "module"))
        for run in ("sweep", "branch"):
            assert one[run].points == other[run].points, run
        for what, seconds in times.items():
            print(f"{what:18s} {min(seconds):8.3f} s")
        print(f"{100 * min(times['graze.run_study']) / min(times['the program']):.1f} % of the program's time")


if __name__ == "__main__":
    main()
