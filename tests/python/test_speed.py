"""Speed, with bounds so generous that a busy machine keeps them; benchmarks/python has the timings themselves."""

import pathlib
import subprocess
import sys

import pytest

import graze

BENCHMARKS = pathlib.Path(__file__).resolve().parents[2] / "benchmarks/python"
sys.path.insert(0, str(BENCHMARKS))

from call_overhead import best_of  # noqa: E402


def test_a_short_motion_costs_microseconds():
    """About 13 us, of which the library takes 8; before jets and lengths were kept it took 65."""
    simulation = graze.Simulation(graze.Model.shipped("impact-oscillator", omega=2.8))
    seconds = best_of(lambda: simulation.run(time=0.01, samples=0), 500, 20)
    print(f"{1e6 * seconds:.1f} us")
    assert seconds < 1e-3


def test_tables_are_made_when_they_are_asked_for():
    simulation = graze.Simulation(graze.Model.shipped("impact-oscillator", omega=2.8))
    motion = simulation.run(periods=10)
    assert motion._tables == {}
    first = motion.samples
    assert list(motion._tables) == ["samples"]
    assert motion.samples is first
    assert motion.contacts is motion.contacts


def test_the_package_is_imported_quickly():
    text = "import time; begun = time.perf_counter(); import graze; print(time.perf_counter() - begun)"
    seconds = min(float(subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True).stdout)
                  for _ in range(3))
    print(f"{1000 * seconds:.0f} ms")
    assert seconds < 2


def test_one_simulation_is_quicker_than_a_new_one_for_each_motion():
    model = graze.Model.shipped("microbeam")
    simulation = graze.Simulation(model)
    once = best_of(lambda: simulation.run(time=1e-9, samples=0), 20, 5)
    each = best_of(lambda: graze.simulate(model.with_(), time=1e-9, samples=0), 20, 5)
    assert once < each


@pytest.mark.parametrize("script, arguments, said", [("call_overhead.py", [], "Simulation.run of one step"),
                                                     ("compare_scipy.py", ["20"], "solve_ivp, DOP853"),
                                                     ("compare_program.py", ["--quick"], "of the program's time")])
def test_benchmarks_run(script, arguments, said):
    if script == "compare_scipy.py":
        pytest.importorskip("scipy")
    ended = subprocess.run([sys.executable, str(BENCHMARKS / script), *arguments], capture_output=True, text=True)
    if "is not built" in ended.stderr:
        pytest.skip("the program graze is not built")
    assert ended.returncode == 0, ended.stderr
    assert said in ended.stdout
    if script == "compare_scipy.py":
        rows = [line.split() for line in ended.stdout.splitlines() if line.startswith(("graze ", "solve_ivp"))]
        errors = [float(row[-2]) for row in rows]
        assert errors[0] < 1e-5
        assert max(errors) < 1e-4
