import math

import numpy
import pytest

import graze


def falling_ball(**parameters):
    return graze.Model.shipped("bouncing-ball", **parameters)


def test_samples_and_contacts_of_a_known_motion():
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    motion = graze.simulate(model, periods=5)
    assert motion.ending == "stopped"
    assert motion.regular
    assert len(motion.t) == len(motion["x"]) == len(motion.samples)
    period = 2 * math.pi / 2.8
    assert motion.end_time == pytest.approx(5 * period, rel=1e-12)
    assert len(motion.contacts) > 0
    # At each contact the speed is reversed by the coefficient of restitution.
    e = model.parameters.e
    assert numpy.allclose(motion.contacts["v_after"], -e * motion.contacts["v"], rtol=1e-12)


def test_given_times_and_dense_output_agree():
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    times = numpy.linspace(0, 3, 31)
    motion = graze.simulate(model, at=times, dense=True)
    assert numpy.array_equal(motion.t, times)
    states = motion(times[1:])
    assert numpy.array_equal(states[:, 0], motion["x"][1:])
    assert numpy.isnan(motion(1e6)).all()
    with pytest.raises(graze.InputError):
        graze.simulate(model, at=[1, 0])
    with pytest.raises(graze.InputError):
        graze.simulate(model, time=1)(0.5)


def test_derivatives_equal_differences():
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    motion = graze.simulate(model, time=3.0, derivatives=["omega"])
    step = 1e-6
    ends = [graze.simulate(model.with_(omega=2.8 + sign * step), time=3.0).end_state["x"] for sign in (1, -1)]
    table = motion.derivatives
    row = [i for i, name in enumerate(table["state"]) if name == "x"][-1]
    assert table["d_omega"][row] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-5)


def test_progress_may_stop():
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    told = []

    def stop(fraction, time):
        told.append((fraction, time))
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        graze.simulate(model, periods=10_000_000, samples=0, progress=stop)
    assert len(told) == 1


def test_wrong_arguments_are_told():
    model = graze.Model.shipped("impact-oscillator")
    for wrong in ({"time": -1}, {"periods": 0.5}, {"samples": -1}, {"samples": 1}, {"sections": "nowhere"},
                  {"tolerance": 1}, {"state": [1]}, {"state": {"y": 1}}, {"mode": "nowhere"}, {"every": 0},
                  {"samples": 5, "every": 0.1}, {"derivatives": "y"}):
        with pytest.raises(graze.InputError):
            graze.simulate(model, **wrong)
    with pytest.raises(TypeError):
        graze.simulate(model, tolerence=1)
