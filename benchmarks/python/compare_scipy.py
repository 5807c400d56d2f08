"""Compares graze with scipy.integrate.solve_ivp and its events: the impact oscillator over many periods, at relative and
absolute tolerances of 1e-9, from state to state at the end. The reference is graze at a tolerance of 1e-14.

usage: PYTHONPATH=build/release/python python3 benchmarks/python/compare_scipy.py [PERIODS]
"""
import math
import sys
import time

import numpy
from scipy.integrate import solve_ivp

import graze


def by_scipy(model: graze.Model, end: float, method: str):
    """The state at the end, and the number of impacts: x'' + 2 zeta x' + x = cos(omega t) below x = sigma, where the
    velocity is reversed and multiplied by e."""
    zeta, sigma, e, omega = (model.parameters[name] for name in ("zeta", "sigma", "e", "omega"))

    def rates(t, y):
        return [y[1], math.cos(omega * t) - y[0] - 2 * zeta * y[1]]

    def stop(t, y):
        return y[0] - sigma

    stop.terminal, stop.direction = True, 1
    t, y, impacts = 0.0, [model.initial["x"], model.initial["v"]], 0
    while t < end:
        solved = solve_ivp(rates, (t, end), y, method=method, events=stop, rtol=1e-9, atol=1e-9)
        t, y = solved.t[-1], solved.y[:, -1]
        if solved.status == 1:
            y = [sigma, -e * y[1]]
            impacts += 1
    return numpy.array(y), impacts


def main() -> None:
    periods = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    # Parameters at which the motion settles on a periodic orbit: on a chaotic one all errors grow to its size.
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    end = 2 * math.pi / model.parameters["omega"] * periods
    exact = graze.simulate(model, time=end, samples=0, tolerance=1e-14)
    truth = numpy.array([exact.end_state["x"], exact.end_state["v"]])

    begun = time.perf_counter()
    simulation = graze.Simulation(model, tolerance=1e-9)
    motion = simulation.run(time=end, samples=0)
    ours = time.perf_counter() - begun
    state = numpy.array([motion.end_state["x"], motion.end_state["v"]])
    print(f"impact oscillator, {periods} periods, tolerance 1e-9")
    print(f"{'':22s} {'seconds':>10s} {'impacts':>8s} {'error':>10s} {'ratio of times':>15s}")
    print(f"{'graze':22s} {ours:10.4f} {len(motion.contacts):8d} {abs(state - truth).max():10.2e} {1:15.0f}")
    for method in ("RK45", "DOP853", "LSODA"):
        begun = time.perf_counter()
        end_state, impacts = by_scipy(model, end, method)
        theirs = time.perf_counter() - begun
        print(f"{'solve_ivp, ' + method:22s} {theirs:10.4f} {impacts:8d} {abs(end_state - truth).max():10.2e} "
              f"{theirs / ours:15.0f}")


if __name__ == "__main__":
    main()
