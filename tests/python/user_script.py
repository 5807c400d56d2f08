"""A script as users write it: mypy --strict accepts it (test_types.py), and it runs."""

from __future__ import annotations

import graze


def amplitude(model: graze.Model, omega: float) -> float:
    motion = graze.simulate(model, skip=20, periods=10, set={"omega": omega}, extrema="x", samples=0)
    table = motion.extrema
    assert table is not None
    return float(max(table["value"]))


def shown(fraction: float | None, time: float) -> bool:
    return fraction is None or fraction <= 1


model: graze.Model = graze.Model.shipped("impact-oscillator", omega=2.8)
model.parameters["omega"] = 2.7
simulation = graze.Simulation(model, sections="phase0", quantities=["energy"], tolerance=1e-10)
motion = simulation.run(periods=20, state={"x": -0.9}, progress=shown, dense=True)
print(motion.ending, motion.end_state["x"] + 1.0, motion.steps, motion(0.5).shape, motion.t.sum())
x, v = graze.symbols("x v")
print((x + 2 * v) ** 2, graze.sin(x), (x > 0) & (v < 1))
swept: graze.Sweep = graze.sweep(model, vary={"omega": (2.7, 2.8, 3)}, cycles=60, threads=1)
print(len(swept.points), amplitude(model, 2.7))
try:
    graze.simulate(model, time=-1)
except graze.InputError as error:
    print(error.problem, error.remedy, error.place)
