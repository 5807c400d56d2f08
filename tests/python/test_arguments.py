"""Arguments: the same checks wherever they are given, and errors that are told at the place in the call."""

import fractions
import os
import pathlib

import numpy
import pytest

import graze
from graze import _arguments, _errors
from graze._facts import Facts


@pytest.mark.parametrize("value", [1, 1.0, fractions.Fraction(1), numpy.float32(1), numpy.int64(1), numpy.array(1.0)])
def test_numbers_of_any_kind_are_numbers(value):
    found = _arguments.number(value, "x")
    assert type(found) is float and found == 1


@pytest.mark.parametrize("value", [True, "1", b"1", None, 1j, [1], float("nan"), float("inf"), 10**400, object()])
def test_other_things_are_no_numbers(value):
    with pytest.raises(graze.InputError) as told:
        _arguments.number(value, "x")
    assert told.value.place == "x" and told.value.remedy


def test_limits_of_numbers():
    assert _arguments.number(float("inf"), "x", finite=False) == float("inf")
    assert _arguments.number(0, "x", least=0) == 0
    for limits in ({"least": 1}, {"above": 0}):
        with pytest.raises(graze.InputError, match="^x: 0"):
            _arguments.number(0, "x", **limits)


def test_whole_numbers():
    assert type(_arguments.whole(numpy.int8(3), "x")) is int
    for wrong in (True, 2.0, "2", 0, 11, None):
        with pytest.raises(graze.InputError, match="^x: "):
            _arguments.whole(wrong, "x", 1, 10)


def test_names_are_texts_or_expressions():
    x = graze.Expression("x")
    assert _arguments.names(x, "n") == ["x"] and _arguments.names(("y", x), "n") == ["y", "x"]
    for wrong in (3, b"x", [1], {"x": 1}, ["\ud800"]):
        with pytest.raises(graze.InputError, match="^n: "):
            _arguments.names(wrong, "n")


def test_paths_of_any_kind_are_paths():
    assert _arguments.path_of(pathlib.Path("a"), "a file") == _arguments.path_of(b"a", "a file") == "a"
    for wrong in ("", "\0"):
        with pytest.raises(graze.FileError, match="no name of a file"):
            _arguments.path_of(wrong, "a file")


def test_an_argument_of_a_wrong_type_is_an_error_of_both_kinds():
    model = graze.Model.shipped("impact-oscillator")
    for wrong in (lambda: graze.simulate(model, mode=3), lambda: graze.read_record(3), lambda: model.save(3),
                  lambda: graze.MeasuredRecord([0, 1], {"x": [0, 1]}, name=3)):
        with pytest.raises(graze.InputError):
            wrong()
        with pytest.raises(TypeError):
            wrong()


def test_all_functions_take_the_same_threads():
    model = graze.Model.shipped("impact-oscillator")
    calls = [lambda threads: graze.sweep(model, vary={"omega": [2.7]}, threads=threads),
             lambda threads: graze.design("mems-switch", threads=threads),
             lambda threads: graze.layout("mems-switch-device").wafers(1, threads=threads),
             lambda threads: graze.run_study("mems-switch", threads=threads)]
    for call in calls:
        for wrong in (0, True, 1.0, "2"):
            with pytest.raises(graze.InputError, match="threads: "):
                call(wrong)


def test_mistakes_are_told_at_another_place():
    error = graze.InputError("a", "b", "text", 3, 4)
    error.all.append(graze.InputError("a", "b", "file", 5, 6))
    moved = _errors.relocated(error, lambda one: f"call, line {one.line}" if one.file == "text" else None, str.upper)
    assert moved is error
    assert [(one.place, one.problem, one.remedy) for one in moved.all] == [("call, line 3", "A", "B"), ("file:5:6", "A", "B")]


def test_facts_are_a_mapping_that_has_the_first_of_each_name():
    facts = Facts(["a", "b", "a"], [1, 2, 3])
    assert dict(facts) == {"a": 1, "b": 2} and len(facts) == 2 and "b" in facts and facts.get("c") is None
    with pytest.raises(KeyError, match="there are a, b"):
        facts["c"]


def test_folders_that_cannot_be_written_are_told(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("")
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    run = graze.sweep(model, vary={"omega": [2.7]}, cycles=60)
    text = 'name = "a"\nmodel = "impact-oscillator"\n[runs.a]\nkind = "sweep"\ncycles = 60\nvary = { omega = [2.7] }\n'
    study = graze.run_study(text)
    layout = graze.layout("mems-switch-device")
    wafers = layout.wafers(1)
    calls = [run.write_study, study.write_tables, study.write_pictures, wafers.save,
             lambda folder: graze.run_study(text, output=folder), lambda folder: run.save(folder / "a.sqlite"),
             lambda folder: layout.save(folder / "a.gds"), lambda folder: model.save(folder / "a.toml")]
    for call in calls:
        with pytest.raises(graze.FileError) as told:
            call(blocked / "folder")
        assert told.value.remedy and "file" in str(told.value)
        with pytest.raises((graze.InputError, TypeError)):
            call(3)
    assert os.listdir(tmp_path) == ["file"]
