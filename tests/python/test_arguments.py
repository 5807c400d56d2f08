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


NO_CHARACTER = "\ud800"


@pytest.fixture(scope="module")
def branch():
    model = graze.Model.shipped("impact-oscillator", omega=2.75)
    return graze.orbit(model).follow(omega=(2.7, 2.8))


@pytest.fixture(scope="module")
def layout():
    return graze.layout("mems-switch-device")


def wrong_texts(branch, value):
    """Calls with a text, or a path, that cannot be used."""
    model, study = branch.model, graze.read_results(branch._store.path)
    paths = [model.save, branch.save, branch.write_study, study.write_tables, study.write_pictures, graze.read_results,
             graze.read_record, graze.run_study, graze.Experiment, graze.design, graze.layout, graze.load,
             lambda path: graze.run_study("mems-switch", output=path), lambda path: graze.record(folder=path, files="x"),
             lambda path: graze.layout("mems-switch-device", from_design=path)]
    texts = [branch.table, branch.query, study.query, study.table, study.plot, graze.design_text,
             lambda text: branch.table("points", label=text), lambda text: graze.points(branch, run=text),
             lambda text: graze.points(branch, type=text), lambda text: graze.run_study("a\n" + text),
             lambda text: branch["EP1"].tolerance(vary={text: 1}), lambda text: branch["EP1"].tolerance(vary={"e": text}),
             lambda text: branch["EP1"].trip(parameter=text), lambda text: branch["EP1"].trip(until=text),
             lambda text: branch["EP1"].grazing(parameter=text), lambda text: branch.figure(**{text: 1}),
             lambda text: graze.sweep(model, vary={text: [1]}), lambda text: graze.sweep(model, vary={"omega": text}),
             lambda text: graze.layout("mems-switch-device", set={"gap": text}),
             *(lambda text, name=name: graze.simulate(model, **{name: text})
               for name in ("time", "after", "every", "quantities", "sections", "extrema", "phase", "mode"))]
    return paths if "\0" in value else paths + texts


@pytest.mark.parametrize("value, words", [(NO_CHARACTER, "no characters"), ("x\0y", "no name of")])
def test_texts_and_paths_that_cannot_be_used_are_told_alike(branch, tmp_path, monkeypatch, value, words):
    monkeypatch.chdir(tmp_path)
    for number, call in enumerate(wrong_texts(branch, value)):
        with pytest.raises(graze.InputError) as told:
            call(value)
        assert words in str(told.value) and told.value.remedy, number
    assert os.listdir() == []


ARRAY = numpy.array([1.0, 2.0])


@pytest.mark.parametrize("place, call", [
    *((name, lambda branch, layout, name=name: graze.simulate(branch.model, **{name: ARRAY}))
      for name in ("derivatives", "dense", "set", "skip", "minima", "samples", "time", "mode")),
    ("mask", lambda branch, layout: layout.gds(ARRAY)), ("mask", lambda branch, layout: layout.polygons(3)),
    ("despite_rules", lambda branch, layout: layout.gds(despite_rules=ARRAY)),
    ("despite_rules", lambda branch, layout: layout.recipe(despite_rules=ARRAY)),
    ("despite_rules", lambda branch, layout: layout.wafers(1, despite_rules=ARRAY)),
    ("wafer", lambda branch, layout: graze.layout("mems-switch-device", wafer=ARRAY)),
    ("models", lambda branch, layout: graze.run_study("a\n", models=ARRAY)),
    ("models, x", lambda branch, layout: graze.run_study("a\n", models={"x": 3})),
    ("set", lambda branch, layout: graze.run_study("a\n", set=3)),
    ("only", lambda branch, layout: graze.run_study("mems-switch", only=[1])),
    ("units", lambda branch, layout: graze.MeasuredRecord([0, 1], {"x": [1, 2]}, units=ARRAY)),
    ("units", lambda branch, layout: graze.MeasuredRecord([0, 1], {"x": [1, 2]}, units=["x"])),
    ("threads", lambda branch, layout: branch.resume(threads=10**30)),
    ("what", lambda branch, layout: branch.table(None)), ("sql", lambda branch, layout: branch.query(None)),
    ("run", lambda branch, layout: graze.points(branch, run=3)), ("name", lambda branch, layout: graze.design_text(None)),
    ("axes", lambda branch, layout: layout.plot(axes="x")), ("axes", lambda branch, layout: layout.plot_steps(axes="x")),
    ("also", lambda branch, layout: branch.figure(also=[None])), ("over", lambda branch, layout: branch.figure(over=[None]))])
def test_arguments_of_other_kinds_are_told_with_their_names(branch, layout, place, call):
    with pytest.raises(graze.InputError) as told:
        call(branch, layout)
    assert place in str(told.value) and told.value.remedy


@pytest.mark.parametrize("read", [graze.design, graze.layout, graze.Experiment, graze.acquire, graze.load, graze.run_study,
                                  graze.read_record])
def test_devices_and_pipes_are_no_texts(tmp_path, read):
    os.mkfifo(tmp_path / "pipe.toml")
    for path, words in (("/dev/zero", "this is a device"), (tmp_path / "pipe.toml", "this is a pipe")):
        with pytest.raises(graze.FileError, match=words):
            read(path)


def test_texts_that_are_too_long_are_told(tmp_path):
    with open(tmp_path / "long.toml", "wb") as file:
        file.truncate((16 << 20) + 1)
    with pytest.raises(graze.FileError, match="more than 16777216 bytes"):
        graze.design(tmp_path / "long.toml")


@pytest.mark.parametrize("name, words, thing", [
    ("omega", "set model.parameters.omega", lambda branch: branch.model),
    ("x", "set model.initial.x", lambda branch: branch.model),
    ("parameterz", "did you mean 'parameters'", lambda branch: branch.model),
    ("tolerance", r"Simulation\(model, tolerance=", lambda branch: graze.Simulation(branch.model)),
    ("periood", "no attribute 'periood'", lambda branch: branch), ("label_", "label_", lambda branch: branch["EP1"]),
    ("endng", "endng", lambda branch: graze.simulate(branch.model, periods=1)),
    ("omga", "omga", lambda branch: branch.points),
    ("holdz", "holdz", lambda branch: graze.layout("mems-switch-device")),
    ("rate", "rate", lambda branch: graze.bench("electromagnetic-testbed")),
    ("unit", "unit", lambda branch: graze.MeasuredRecord([0, 1], {"x": [1, 2]}))])
def test_attributes_that_there_are_not_cannot_be_set(branch, name, words, thing):
    with pytest.raises(AttributeError, match=words):
        setattr(thing(branch), name, 99)
