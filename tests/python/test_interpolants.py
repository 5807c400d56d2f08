"""Functions that are known at some points, in expressions and models written in Python."""

import copy
import math
import pickle

import numpy
import pytest

import graze

SPRING = [(-0.1, -9), (-0.05, -2), (0, 0), (0.05, 2), (0.1, 9)]


def test_values():
    line = graze.Interpolant("line", SPRING, outside="linear")
    assert line(0.025) == 1
    assert line(0.2) == pytest.approx(9 + 140*0.1, rel=1e-15)
    assert graze.Interpolant("line", numpy.array(SPRING))(0.2) == 9
    wave = graze.Interpolant("wave", [(x, math.sin(x)) for x in numpy.linspace(0, 2*math.pi, 65)[:-1]] + [(2*math.pi, 0.0)],
                             interpolation="cubic", periodic=True)
    assert wave(7) == pytest.approx(math.sin(7), abs=1e-6)


def test_model_has_the_tables_of_its_expressions():
    x, v = graze.states(x=0.06, v=0)
    spring = graze.Interpolant("spring", SPRING, outside="linear", text="measured")
    model = graze.Model("seat", rates={x: v, v: -spring(x)})
    assert "[tables.spring]" in str(model)
    # Between 0.05 and 0.1 the force is 2 + 140 (x - 0.05): a harmonic motion about 0.05 - 2/140.
    about = 0.05 - 2/140
    expected = about + (0.06 - about)*math.cos(math.sqrt(140)*0.05)
    motion = graze.simulate(model, time=0.05)
    assert motion["x"][-1] == pytest.approx(expected, rel=1e-12)


def test_texts_need_the_list():
    spring = graze.Interpolant("spring", SPRING)
    model = graze.Model("seat", states={"x": 0.06, "v": 0}, rates={"x": "v", "v": "-spring(x)"}, tables=[spring])
    other = graze.Model("seat", states={"x": 0.06, "v": 0}, rates={"x": "v", "v": -spring(graze.symbols("x"))})
    assert str(model) == str(other)
    with pytest.raises(graze.ModelError, match="unknown function 'spring'"):
        graze.Model("seat", states={"x": 0.06, "v": 0}, rates={"x": "v", "v": "-spring(x)"})


def test_conditions_and_events_bring_their_tables():
    x, v = graze.states(x=1, v=0)
    floor = graze.Interpolant("floor", [(0, 0), (1, 0.5)])
    model = graze.Model("ball", rates={x: v, v: -1}, events={"contact": x - floor(x)},
                        transitions=[graze.Transition("contact", jump={v: -v}, next=[(floor(v) > 0.1, "motion"), "end"])])
    assert str(model).count("[tables.floor]") == 1


def test_copies():
    x = graze.symbols("x")
    spring = graze.Interpolant("spring", SPRING, interpolation="cubic")
    for again in (pickle.loads(pickle.dumps(spring)), copy.deepcopy(spring)):
        assert again == spring
        assert again(x) == spring(x)
    force = 2*spring(x**2) + x
    assert pickle.loads(pickle.dumps(force)) == force
    assert str(force) == "x + 2*spring(x^2)"
    assert float(force.substitute(x=0.2)) == pytest.approx(2*spring(0.04) + 0.2, rel=1e-15)
    assert float(spring(x).derivative(x).substitute(x=0.05)) == pytest.approx(
        (spring(0.05 + 1e-6) - spring(0.05 - 1e-6))/2e-6, rel=1e-6)


@pytest.mark.parametrize("make, problem", [
    (lambda: graze.Interpolant("f", [(0, 1)]), "point"),
    (lambda: graze.Interpolant("f", [(0, 1), (0, 2)]), "increase"),
    (lambda: graze.Interpolant("f", [(0, 1), 2]), r"points\[1\], 2, is no pair"),
    (lambda: graze.Interpolant("f", [(0, 1), (1, math.nan)]), "finite"),
    (lambda: graze.Interpolant("f", SPRING, interpolation="quintic"), "'quintic' is not known; give 'linear' or 'cubic'"),
    (lambda: graze.Interpolant("f", SPRING, periodic=True), "end"),
    (lambda: graze.Interpolant("2f", SPRING), "cannot be a name"),
    (lambda: graze.Interpolant("sin", SPRING), "reserved"),
    (lambda: graze.Interpolant("f", SPRING, outside="error")(0.2), "no number"),
    (lambda: graze.Model("m", rates={"x": graze.Interpolant("f", SPRING)(graze.symbols("x"))
                                     + graze.Interpolant("f", SPRING[1:])(graze.symbols("x"))}), "name"),
    (lambda: graze.Model("m", rates={"x": "x"}, tables=["f"]), r"tables\[0\].*no graze.Interpolant"),
])
def test_mistakes_are_told(make, problem):
    with pytest.raises(graze.InputError, match=problem):
        make()


def test_transitions_say_when_and_at_once():
    x, y, v = graze.states(x=1, y=1, v=1)
    model = graze.Model("corner", rates={x: -v, y: -v, v: 0}, events={"left": x, "low": y}, transitions=[
        graze.Transition("left", jump={v: -v}, also="low", label="both"),
        graze.Transition("left", jump={v: -v}, when=y > 0.5, label="high"),
        graze.Transition("left", jump={v: -v}),
        graze.Transition("low", jump={v: -v})])
    motion = graze.simulate(model, time=1.5)
    assert list(motion.contacts["transition"]) == ["both"]
    with pytest.raises(graze.ModelError, match="is no condition"):
        graze.Model("m", rates={x: 1}, events={"e": x}, transitions=[graze.Transition("e", when=3)])
