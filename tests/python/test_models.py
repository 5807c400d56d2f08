import copy
import math
import pickle

import pytest

import graze


def test_a_shipped_model_has_parameters_with_units():
    model = graze.Model.shipped("impact-oscillator")
    assert "impact-oscillator" in graze.models()
    assert model.name == "impact-oscillator"
    model.parameters.omega = 2.8
    assert model.parameters["omega"] == 2.8
    assert set(model.parameters.units) == set(model.parameters)
    with pytest.raises(AttributeError):
        model.parameters.omeg
    with pytest.raises(graze.ModelError) as told:
        model.parameters["omeg"] = 1
    assert "omega" in told.value.remedy


def test_text_and_pickle_give_the_same_model():
    model = graze.Model.shipped("mems-switch")
    again = graze.Model(text=str(model))
    assert str(again) == str(model)
    assert pickle.loads(pickle.dumps(model)) == model
    other = copy.copy(model)
    name = model.parameters.independent[0]
    other.parameters[name] *= 2
    assert other.parameters[name] == 2 * model.parameters[name]


def test_mistakes_have_places():
    with pytest.raises(graze.ModelError) as told:
        graze.Model(text='name = "x"\n[states.q]\ninitial = "1 +"\n')
    assert told.value.line > 0
    assert len(told.value.all) >= 1
    again = pickle.loads(pickle.dumps(told.value))
    assert str(again) == str(told.value)
    with pytest.raises(graze.InputError):
        graze.load("/nowhere/model.toml")


def test_expressions_are_made_by_operators():
    x, v = graze.symbols("x v")
    assert str(x + 2 * v) in ("x + 2*v", "2*v + x")
    other = graze.symbols("k")
    assert set((other * x).symbols) == {"x", "k"}
    assert (x * x).derivative(x) == 2 * x
    assert graze.sin(0.5) == math.sin(0.5)
    assert str(graze.sin(x)) == "sin(x)"
    assert pickle.loads(pickle.dumps(x**2 + 2 * v)) == x**2 + 2 * v
    assert str((x > 0) & (v <= 1)) == "x > 0 and v <= 1"
    with pytest.raises(graze.InputError):
        bool(x > 0)
