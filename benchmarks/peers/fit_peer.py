#!/usr/bin/env python3
"""The same records fitted by graze and by scipy's least_squares over an integrator of fixed steps.

usage: fit_peer.py GRAZE        needs python3-scipy

An impact oscillator is simulated, its position and velocity are read with noise, and damping, frequency, stop and
restitution are found, with the three initial states. scipy integrates by the classical Runge-Kutta method in steps of
fixed length, finds impacts within a step by the cubic that its ends have, and takes derivatives by differences: what
one writes without a library for hybrid systems. It begins where graze begins. Both see the same files.
"""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
import time

import numpy
from scipy.optimize import least_squares

TRUTH = {"zeta": 0.02, "omega": 2.5, "sigma": 0.1, "e": 0.8}


def simulate(graze, folder, duration, spacing):
    path = os.path.join(folder, "motion.csv")
    subprocess.run([graze, "simulate", "impact-oscillator", "--time", str(duration), "--every", str(spacing),
                    "--format", "csv", "--output", path], check=True, stderr=subprocess.DEVNULL)
    with open(path, encoding="ascii") as file:
        rows = [[float(row["time"]), float(row["x"]), float(row["v"])] for row in csv.DictReader(file)]
    return numpy.array(rows)


def rates(state, zeta, omega):
    x, v, theta = state
    return (v, math.cos(theta) - 2 * zeta * v - x, omega)


def runge_kutta(state, step, zeta, omega):
    a = rates(state, zeta, omega)
    b = rates([s + 0.5 * step * r for s, r in zip(state, a)], zeta, omega)
    c = rates([s + 0.5 * step * r for s, r in zip(state, b)], zeta, omega)
    d = rates([s + step * r for s, r in zip(state, c)], zeta, omega)
    return [s + step / 6 * (p + 2 * q + 2 * r + w) for s, p, q, r, w in zip(state, a, b, c, d)]


def advance(state, length, zeta, omega, sigma, e):
    """Along one step of fixed length, with impacts by bisection of shorter steps."""
    for _ in range(50):
        after = runge_kutta(state, length, zeta, omega)
        if after[0] <= sigma or state[0] > sigma:
            return after
        low, high = 0.0, length
        for _ in range(50):
            middle = 0.5 * (low + high)
            if runge_kutta(state, middle, zeta, omega)[0] < sigma:
                low = middle
            else:
                high = middle
        state = runge_kutta(state, low, zeta, omega)
        state[1] = -e * state[1]
        length -= low
        if length <= 0:
            break
    return state


def residuals(unknowns, times, read, steps, weights):
    zeta, omega, sigma, e = unknowns[:4]
    state, left = list(unknowns[4:]), []
    for i, at in enumerate(times):
        if i > 0:
            step = (at - times[i - 1]) / steps
            for _ in range(steps):
                state = advance(state, step, zeta, omega, sigma, e)
        left += [(state[0] - read[i, 0]) * weights[0], (state[1] - read[i, 1]) * weights[1]]
    return numpy.array(left)


def compare(graze, folder, duration, off, steps):
    rows = simulate(graze, folder, duration, 0.05)
    chance = numpy.random.default_rng(7)
    noise = 0.005 * numpy.ptp(rows[:, 1:], axis=0)
    rows[:, 1:] += noise * chance.standard_normal((len(rows), 2))
    record = os.path.join(folder, "record.csv")
    numpy.savetxt(record, rows, delimiter=",", header="t,x,v", comments="", fmt="%.17g")

    guesses = {name: value * off for name, value in TRUTH.items()}
    begun = time.perf_counter()
    done = subprocess.run([graze, "identify", "fit", "impact-oscillator", record, "--format", "json", "--free",
                           ",".join(f"{name}={value!r}" for name, value in guesses.items())],
                          capture_output=True, text=True, check=False)
    ours_time = time.perf_counter() - begun
    ours = json.loads(done.stdout) if done.stdout else {"ending": "none", "rows": []}
    found = {row[0]: (row[2], row[3]) for row in ours["rows"]}

    start = [guesses[name] for name in TRUTH] + [rows[0, 1], rows[0, 2], 0.0]
    begun = time.perf_counter()
    theirs = least_squares(residuals, start, args=(rows[:, 0], rows[:, 1:], steps, 1 / noise), x_scale="jac")
    theirs_time = time.perf_counter() - begun

    print(f"{duration:g} units of time, {len(rows)} readings of x and v, guesses off by {off - 1:.0%}:")
    print(f"  graze: {ours['ending']}, {ours_time:.3f} s; scipy: {theirs_time:.3f} s "
          f"with {steps} steps a reading, {theirs.nfev} evaluations; ratio {theirs_time / ours_time:.1f}")
    for i, (name, value) in enumerate(TRUTH.items()):
        mine, error = found.get(name, (math.nan, math.nan))
        print(f"  {name:6} graze {(mine - value) / value:+.2e} scipy {(theirs.x[i] - value) / value:+.2e} "
              f"(standard error {error / value if error else math.nan:.1e})")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        compare(sys.argv[1], folder, 10, 1.02, 2)
        compare(sys.argv[1], folder, 30, 1.02, 2)
        compare(sys.argv[1], folder, 30, 1.1, 2)


if __name__ == "__main__":
    main()
