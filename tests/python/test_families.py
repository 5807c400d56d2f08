"""Families of orbits, followed along what is conserved or along the period."""

import math

import pytest

import graze


def pendulum():
    q, w = graze.states("q w")
    return graze.Model("pendulum", states={q: 0.5, w: 0}, rates={q: w, w: -graze.sin(q)},
                       sections={"turn": graze.Section(w, direction="falling")},
                       conserved={"energy": graze.Conserved(w**2/2 - graze.cos(q), unit="J")})


def period_of(energy):
    a, b = 1, math.sqrt((1 - energy) / 2)
    for _ in range(8):
        a, b = (a + b) / 2, math.sqrt(a * b)
    return 2 * math.pi / a


def test_a_family_is_followed_along_its_energy():
    model = pendulum()
    assert model.conserved == ("energy",)
    branch = graze.follow(model, energy=(-0.95, 0.9), signature="turn")
    assert branch.parameter == "energy"
    for energy, period in zip(branch.points["energy"], branch.points["period"]):
        assert period == pytest.approx(period_of(energy), rel=1e-10)
    assert min(branch.points["energy"]) == pytest.approx(-0.95, abs=1e-11)
    assert max(branch.points["energy"]) == pytest.approx(0.9, abs=1e-11)


def test_a_family_is_followed_along_its_period():
    branch = graze.follow(pendulum(), along={"period": (6.35, 9)}, signature="turn", direction="up")
    assert max(branch.points["period"]) == pytest.approx(9, abs=1e-10)


def test_names_are_told():
    with pytest.raises(graze.Error, match="energy"):
        graze.follow(pendulum(), along={"energi": (0, 1)}, signature="turn")


def test_modes_may_have_expressions_of_their_own():
    y, v = graze.states("y v")
    model = graze.Model("ball", states={y: 1, v: 0}, initial_mode="air",
                        modes={"air": graze.Mode({y: v, v: -1}, watch=["ground"]),
                               "ground": graze.Mode({y: v, v: -1 - 50*y}, watch=["leave"])},
                        events={"ground": graze.Event(y, kind="section"), "leave": graze.Event(-y, kind="section")},
                        transitions=[graze.Transition("ground", mode="air", next="ground", label="land"),
                                     graze.Transition("leave", mode="ground", next="air", label="leave")],
                        conserved={"energy": graze.Conserved(v**2/2 + y, modes={"ground": v**2/2 + y + 25*y**2})})
    branch = graze.follow(model, energy=(0.5, 2), signature="land leave")
    for energy, period in zip(branch.points["energy"], branch.points["period"]):
        omega, fall = math.sqrt(50), math.sqrt(2 * energy)
        stay = (math.pi + 2 * math.atan(1 / (omega * fall))) / omega
        assert period == pytest.approx(2 * fall + stay, rel=1e-9)
