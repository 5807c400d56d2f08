"""`graze.design`: numbers as the program prints them (docs/design.md is checked against the program), closed forms, what
is written, and wrong uses."""

import copy
import json
import os
import pathlib
import pickle
import re

import pytest

import graze
from graze._design_text import DesignText

ROOT = pathlib.Path(__file__).parents[2]
QUICK = {"yield_": {"devices": 50}, "points": {"curve": 5, "plane": 3}, "trip": {"overshoots": [1e-2]}}
MINE = re.search(r"```toml file=mine.toml\n(.*?)```", (ROOT / "docs/design.md").read_text(), re.S).group(1)


def printed(after):
    """The quantities, and their values, of the output block that follows these words in docs/design.md."""
    text = (ROOT / "docs/design.md").read_text()
    block = re.search(r"```text output\n(.*?)```", text[text.index(after):], re.S).group(1)
    return {line.split()[0]: line.split()[1] for line in block.splitlines() if not line.startswith("quantity")}


def digits(value):
    return value if isinstance(value, str) else f"{value:.6g}"


@pytest.fixture(scope="module")
def switch():
    return graze.design("mems-switch")


@pytest.fixture(scope="module")
def quick():
    return graze.design("mems-switch", **QUICK)


def test_facts_are_those_of_the_program(switch):
    shown = printed("graze design mems-switch --output switch")
    assert len(shown) > 25
    assert {name: digits(switch[name]) for name in switch} == shown
    assert switch.trip_value == switch["trip_value"]
    assert switch.outcome == switch["class"] == "trips"
    assert switch.reset_value is None
    assert switch.regular and switch.warnings == [] and switch.wishes == "" and switch.problems == {}


def test_sensitivities_are_derivatives(switch):
    step = 1e-4
    exact = dict(zip(switch.sensitivities["parameter"], switch.sensitivities["dV"]))
    for name, value in switch.dimensions.items():
        values = []
        for sign in (1, -1):
            other = graze.design("mems-switch", set={name: value * (1 + sign * step)}, **QUICK)
            values.append(other.trip_value)
        assert exact[name] == pytest.approx((values[0] - values[1]) / (2 * step * value), rel=3e-5)


def test_tables_have_the_points_that_were_asked_for(quick):
    assert list(quick.curves) == ["delta", "zeta", "omega"]
    assert len(quick.curves["delta"]) == 5
    assert len(quick.planes["delta", "zeta"]) == 9
    assert len(quick.devices) == 50
    assert quick.devices is quick.tables["devices"]
    assert len(quick.trip_times) == 1
    # The middle of a curve over a range is the trip value of a device with that dimension.
    middle = graze.design("mems-switch", set={"delta": quick.curves["delta"]["delta"][2]}, **QUICK)
    assert quick.curves["delta"]["V"][2] == pytest.approx(middle.trip_value, rel=1e-9)


def test_device_touches_at_its_trip_value(quick):
    assert quick.device.parameters["V"] == pytest.approx(quick.trip_value, rel=1e-12)
    motion = graze.simulate(quick.device, periods=1, extrema="q", samples=0)
    assert min(motion.extrema["value"]) == pytest.approx(-quick.device.parameters["delta"], rel=1e-8)
    branch = quick.results["approach"]
    assert branch["GR1"].parameter == pytest.approx(quick.trip_value, rel=1e-12)


def test_wishes_of_the_documentation():
    found = graze.design(text=MINE)
    shown = printed("graze design mine.toml --output mine")
    values = {name: digits(found[name]) for name in shown}
    assert values == shown
    assert found.wishes == "met" and found.regular
    wants = found.wants
    assert wants["name"] == ["value", "class", "sensitivity_omega", "trip_time"]
    assert wants.met.all()
    assert found.dimensions["delta"] == pytest.approx(float(shown["delta"]), rel=1e-5)


def test_keywords_say_the_same_as_a_file():
    import tomllib

    keys = tomllib.loads(MINE)
    keys["yield_"] = keys.pop("yield")
    del keys["model"]
    one = graze.design(text=MINE)
    other = graze.design(model=graze.Model.shipped("mems-switch"), **keys)
    assert json.loads(one.report)["facts"] == json.loads(other.report)["facts"]
    assert one.tables["devices"] == other.tables["devices"]


def test_threads_do_not_change_results(quick):
    assert graze.design("mems-switch", threads=3, **QUICK).report == quick.report


def test_wishes_that_cannot_be_met():
    found = graze.design(text=MINE, wanted={"sensitivity": {"omega": 2}}, yield_={"devices": 50}, points={"plane": 3})
    assert found.wishes == "unmet" and not found.regular
    assert any("what is wanted" in warning for warning in found.warnings)
    assert not found.wants.met.all()


def test_saving_and_reading(quick, tmp_path):
    folder = tmp_path / "switch"
    written = quick.save(folder)
    names = {os.path.basename(path) for path in written}
    assert {"facts.csv", "report.json", "device.toml", "results.sqlite", "page.svg", "page.pdf"} <= names
    assert all(os.path.getsize(path) > 0 for path in written)
    assert json.loads((folder / "report.json").read_text())["design"] == "mems-switch"
    assert graze.load(folder / "device.toml").parameters == quick.device.parameters
    assert "approach" in graze.read_results(folder / "results.sqlite")
    with pytest.raises(graze.FileError, match="already"):
        quick.save(folder)


def test_page(quick):
    axes = quick.plot()
    assert len(axes) == 7  # three curves, a plane, trip times, tuning, devices
    assert "trip_value" in quick._repr_html_()
    assert "trips at V = 0.201366" in repr(quick)


def test_shipped_designs():
    assert "mems-switch" in graze.designs()
    assert graze.design_text("mems-switch") == (ROOT / "designs/mems-switch.toml").read_text()


def test_progress_and_interruption():
    told = []
    graze.design("mems-switch", progress=lambda text: told.append(text))
    assert told and all(isinstance(text, str) for text in told)
    with pytest.raises(graze.Interrupted):
        graze.design("mems-switch", yield_={"devices": 100000}, progress=lambda text: False)

    def fails(text):
        raise RuntimeError("mine")

    with pytest.raises(RuntimeError, match="mine"):
        graze.design("mems-switch", yield_={"devices": 100000}, progress=fails)


@pytest.mark.parametrize("given, words", [
    (dict(design="mems-swich"), "mems-switch"),
    (dict(design="./absent.toml"), "cannot be read"),
    (dict(design=3), "shipped design"),
    (dict(design="mems-switch", text="name = 'x'"), "one of them"),
    (dict(text=3), "text"),
    (dict(), "name"),
    (dict(design="mems-switch", control="W"), "W"),
    (dict(design="mems-switch", colour="red"), "colour"),
    (dict(design="mems-switch", threads=0), "threads"),
    (dict(design="mems-switch", dimensions={"delta": {"range": [0.8, 0.3]}}), "range"),
    (dict(design="mems-switch", dimensions={"delta": {"range": object()}}), "range"),
    (dict(design="mems-switch", approach={"event": "stopp"}), "stop"),
    (dict(design="mems-switch", wanted={"class": "flies"}), "trips"),
    (dict(design="mems-switch", wanted={"yield": 1.5}), "yield"),
    (dict(design="mems-switch", yield_={"devices": -1}), "devices"),
    (dict(design="mems-switch", model="absent"), "absent"),
    (dict(text="name = "), "not TOML"),
    (dict(design="mems-switch", wantd=None), "design.., wantd: unknown key 'wantd'; did you mean 'wanted'"),
    (dict(design="mems-switch", wanted={"vlaue": None}), "design.., wanted: unknown key 'vlaue'"),
])
def test_wrong_uses(given, words):
    with pytest.raises(graze.InputError, match=words) as raised:
        graze.design(**given)
    assert not isinstance(raised.value, graze.InternalError)


def test_known_keys_may_be_not_given():
    one, other = (DesignText("mems-switch", None, keys, "design()").text
                  for keys in ({"wanted": None, "yield_": None}, {"wanted": None, "trip": {"until": None}}))
    assert "wanted" not in one and "wanted" not in other


def test_mistakes_are_told_with_the_keyword():
    with pytest.raises(graze.InputError) as raised:
        graze.design("mems-switch", approach={"event": "stopp"}, wanted={"class": "flies"})
    assert [one.place for one in raised.value.all] == ["design(), approach", "design(), wanted"]


def test_wrong_types():
    with pytest.raises(TypeError):
        graze.design("mems-switch", progress=3)


def test_designs_can_be_copied_and_pickled(quick, tmp_path):
    for made in (pickle.loads(pickle.dumps(quick)), copy.deepcopy(quick), pickle.loads(pickle.dumps(copy.copy(quick)))):
        assert dict(made) == dict(quick) and made.tables == quick.tables and made.wants == quick.wants
        assert (made.report, made.device, made.dimensions) == (quick.report, quick.device, quick.dimensions)
        assert made.results["approach"].points == quick.results["approach"].points
        with pytest.raises(graze.OrderError, match="not kept in copies"):
            made.plot()
    written = made.save(tmp_path / "copy", pictures=False)
    assert written == [path.replace("whole", "copy") for path in quick.save(tmp_path / "whole", pictures=False)]
    for path in written:
        if not path.endswith(".sqlite"):
            assert pathlib.Path(path).read_text() == pathlib.Path(path.replace("copy", "whole")).read_text()
