"""Motions: all that `graze simulate` can do, against closed forms and against the program."""

import csv
import gc
import io
import itertools
import math
import os
import pathlib
import pickle
import subprocess

import numpy
import pytest

import graze

OSCILLATOR = {"omega": 2.8}


@pytest.fixture
def model():
    return graze.Model.shipped("impact-oscillator", **OSCILLATOR)


def program():
    """The program `graze` of the same build, or that of the variable GRAZE."""
    beside = pathlib.Path(graze.__file__).parents[2] / "bin/graze"
    path = os.environ.get("GRAZE", beside if beside.exists() else None)
    if path is None:
        pytest.skip("the program graze is not built")
    return str(path)


def table_of_program(*arguments):
    """The table that `graze simulate` prints, as columns of numbers (NaN for empty cells) or texts."""
    output = subprocess.run([program(), "simulate", *arguments, "--format", "csv"], check=True, capture_output=True,
                            text=True).stdout
    names, *rows = csv.reader(line for line in io.StringIO(output) if not line.startswith("#"))

    def column(cells):
        try:
            return [float(cell) if cell else math.nan for cell in cells]
        except ValueError:
            return list(cells)

    return {name: column(cells) for name, cells in zip(names, zip(*rows))}


def assert_same(table, printed):
    assert [name.split(" ")[0] for name in printed] == list(table)
    for (name, cells), ours in zip(printed.items(), table.values()):
        assert len(cells) == len(ours), name
        if isinstance(ours, list):
            assert cells == ours, name
        else:
            assert numpy.array_equal(cells, ours, equal_nan=True), name


COMPARED = {
    "samples": (["impact-oscillator", "--set", "omega=2.8"], {}, "samples"),
    "every": (["impact-oscillator", "--set", "omega=2.8", "--every", "0.25", "--time", "9"],
              {"every": 0.25, "time": 9}, "samples"),
    "quantities": (["impact-oscillator", "--set", "omega=2.8", "--samples", "60", "--time", "4*pi/omega", "--after", "1",
                    "--quantity", "energy", "--quantity", "x*omega"],
                   {"samples": 60, "time": "4*pi/omega", "after": 1, "quantities": ["energy", "x*omega"]}, "samples"),
    "contacts": (["impact-oscillator", "--set", "omega=2.8", "--contacts", "40"], {"contacts": 40}, "contacts"),
    "events": (["bouncing-ball", "--set", "a=0.003", "--set", "e=0.2", "--event", "release", "--contacts", "4"],
               {"set": {"a": 0.003, "e": 0.2}, "events": "release", "contacts": 4}, "contacts"),
    "sections": (["impact-oscillator", "--set", "omega=2.8", "--skip", "10", "--periods", "30", "--section", "phase0"],
                 {"skip": 10, "periods": 30, "sections": "phase0"}, "sections"),
    "extrema": (["impact-oscillator", "--set", "omega=2.8", "--extrema", "x", "--extrema", "v^2"],
                {"extrema": ["x", "v^2"]}, "extrema"),
    "minima": (["impact-oscillator", "--set", "omega=2.8", "--minima"], {"minima": True}, "minima"),
    "derivatives": (["impact-oscillator", "--set", "omega=2.8", "--time", "4", "--derivatives", "all"],
                    {"time": 4, "derivatives": "all"}, "derivatives"),
    "summary": (["impact-oscillator", "--set", "omega=2.8", "--table", "summary", "--quantity", "energy", "--mode", "free",
                 "--from", "x=-1.5"],
                {"state": {"x": -1.5}, "mode": "free", "quantities": "energy"}, "summary"),
    "method": (["impact-oscillator", "--set", "omega=2.8", "--tolerance", "1e-8", "--order", "12", "--largest-step",
                "pi/20", "--samples", "40"],
               {"tolerance": 1e-8, "order": 12, "largest_step": "pi/20", "samples": 40}, "samples"),
}


@pytest.mark.parametrize("what", COMPARED)
def test_tables_equal_those_of_the_program(model, what):
    arguments, keys, table = COMPARED[what]
    if arguments[0] != model.name:
        model = graze.Model.shipped(arguments[0])
    motion = graze.simulate(model, **keys)
    printed = table_of_program(*arguments, "--digits", "17")
    assert len(getattr(motion, table)) > 0
    assert_same(getattr(motion, table), printed)


def test_a_falling_ball_has_known_contacts():
    """Heights of free fall in closed form: z = h - g t^2/2, contacts after sqrt(2 h/g), then 2 e^k v/g apart."""
    ball = graze.Model.shipped("bouncing-ball", a=0)  # above a table at rest
    g, e, h = ball.parameters.g, ball.parameters.e, ball.initial["x"]
    motion = graze.simulate(ball, contacts=6, samples=0, dense=True)
    first = math.sqrt(2 * h / g)
    times = list(itertools.accumulate([first] + [2 * first * e**k for k in range(1, 6)]))
    assert motion.contacts["time"] == pytest.approx(times, rel=1e-13)
    assert motion.contacts["v_after"] == pytest.approx(-e * motion.contacts["v"], rel=1e-14)
    asked = numpy.linspace(0, first, 9)[1:-1]
    assert motion(asked)[:, 0] == pytest.approx(h - g * asked**2 / 2, rel=1e-12)


def test_samples_and_contacts_of_a_known_motion(model):
    motion = graze.simulate(model, periods=5)
    assert motion.ending == "stopped"
    assert motion.regular
    assert len(motion.t) == len(motion["x"]) == len(motion.samples)
    period = 2 * math.pi / 2.8
    assert motion.end_time == pytest.approx(5 * period, rel=1e-12)
    assert len(motion.contacts) > 0
    e = model.parameters.e
    assert numpy.allclose(motion.contacts["v_after"], -e * motion.contacts["v"], rtol=1e-12)
    assert motion.samples.units == {}
    assert set(motion.end_state) == {"x", "v", "theta"}
    assert "x" in dir(motion)
    assert "bar" not in dir(motion)
    with pytest.raises(AttributeError):
        motion.bar


def test_given_times_and_dense_output_agree(model):
    times = numpy.linspace(0, 3, 31)
    motion = graze.simulate(model, at=times, dense=True, quantities="x*omega")
    assert numpy.array_equal(motion.t, times)
    assert list(motion.samples) == ["time", "mode", "x", "v", "theta", "x*omega"]
    assert numpy.array_equal(motion["x*omega"], motion["x"] * 2.8)
    states = motion(times[1:])
    assert states.shape == (30, 3)
    assert numpy.array_equal(states[:, 0], motion["x"][1:])
    assert numpy.array_equal(motion(times[1:].reshape(5, 6)), states.reshape(5, 6, 3))
    assert numpy.array_equal(motion(times[1]), states[0])
    assert numpy.isnan(motion(1e6)).all()
    assert numpy.isnan(motion(math.nan)).all()
    # The first and the last of the times are there although the end is reached to a round-off error only.
    for end in numpy.linspace(0.1, 40, 23):
        assert len(graze.simulate(model, at=[0, end / 3, end], after=0.7).samples) == 3
    later = graze.simulate(model, at=times, after=2.0)
    assert numpy.array_equal(later.t, 2.0 + times)
    assert later["x"] == pytest.approx(graze.simulate(model, at=2.0 + times)["x"], abs=1e-12)
    for wrong in ([1, 0], [-1, 2], [math.nan], [math.inf], [], [[1, 2]], 5, "abc"):
        with pytest.raises(ValueError):
            graze.simulate(model, at=wrong)
    with pytest.raises(graze.InputError):
        graze.simulate(model, at=[1, 2], time=1.5)
    with pytest.raises(graze.InputError):
        graze.simulate(model, time=1)(0.5)


def test_derivatives_equal_differences(model):
    motion = graze.simulate(model, time=3.0, derivatives=["omega"])
    step = 1e-6
    ends = [graze.simulate(model, time=3.0, set={"omega": 2.8 + sign * step}).end_state["x"] for sign in (1, -1)]
    table = motion.derivatives
    row = table["state"].index("x")
    assert table["d_omega"][row] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-5)
    # A simulation without derivatives takes the same steps.
    assert motion.end_state == graze.simulate(model, time=3.0).end_state
    everything = graze.simulate(model, time=3.0, derivatives="all").derivatives
    assert list(everything) == ["state", "value", "d_x", "d_v", "d_theta",
                                *("d_" + name for name in model.parameters.independent)]
    assert numpy.array_equal(everything["d_omega"], table["d_omega"])


def test_parameters_count_wherever_they_are_set(model):
    """Quantities and periods follow values that are set after a model was compiled, and those of one run."""
    graze.simulate(model, time=1)
    expected = graze.simulate(graze.Model.shipped("impact-oscillator", omega=1.0), periods=2, quantities="omega*x",
                              extrema="omega*v", sections="phase0")
    simulation = graze.Simulation(model, quantities="omega*x", extrema="omega*v", sections="phase0")
    once = simulation.run(periods=2, set={"omega": 1.0})
    model.parameters.omega = 1.0
    changed = graze.simulate(model, periods=2, quantities="omega*x", extrema="omega*v", sections="phase0")
    for motion in (once, changed):
        for table in ("samples", "contacts", "extrema", "sections", "summary"):
            assert getattr(motion, table) == getattr(expected, table)
    # A simulation keeps the model as it was.
    assert simulation.run(periods=2).samples["omega*x"] == pytest.approx(2.8 * simulation.run(periods=2)["x"])
    assert once.end_time == pytest.approx(4 * math.pi)
    with pytest.raises(graze.InputError) as told:
        simulation.run(set={"omeg": 1})
    assert "omega" in told.value.remedy


def test_periods_count_from_the_phase_with_which_a_motion_begins(model):
    period = 2 * math.pi / 2.8
    for phase in (0.0, 1.0, 5.0):
        for state in ({"theta": phase}, [-0.9, 0.0, phase]):
            motion = graze.simulate(model, periods=3, state=state)
            assert motion.end_time == pytest.approx(3 * period, rel=1e-12)
    # Motions may go on from where another one has ended.
    whole = graze.simulate(model, periods=6)
    half = graze.simulate(model, periods=3)
    rest = graze.simulate(model, periods=3, state=half.end_state, mode=half.end_mode)
    assert rest.end_state["x"] == pytest.approx(whole.end_state["x"], abs=1e-9)
    assert rest.end_time == pytest.approx(whole.end_time / 2, rel=1e-12)


def test_a_simulation_gives_the_same_bits_again(model):
    simulation = graze.Simulation(model, extrema=["x"], quantities=["energy"])
    first = simulation.run(periods=10)
    for keys in ({"time": 3}, {"periods": 4, "set": {"omega": 3.0}}, {"contacts": 5, "derivatives": "x"},
                 {"skip": 3, "periods": 2, "state": [-0.5, 0.1, 0.2]}):
        simulation.run(**keys)
    again = simulation.run(periods=10)
    fresh = graze.simulate(model, periods=10, extrema="x", quantities="energy")
    for motion in (again, fresh):
        assert motion.samples == first.samples
        assert motion.extrema == first.extrema
        assert motion.contacts == first.contacts
        assert motion.end_state == first.end_state


def test_results_outlive_model_and_simulation(model):
    simulation = graze.Simulation(model, extrema="x")
    motion = simulation.run(periods=4, dense=True)
    expected = graze.simulate(model, periods=4, extrema="x")
    x = motion["x"]
    model.parameters.omega = 5.0
    del simulation, model
    gc.collect()
    assert motion.extrema == expected.extrema
    assert motion.model.parameters.omega == 2.8
    kept = motion.samples
    del motion
    gc.collect()
    numpy.ones(100_000)  # takes the memory, had it been given back
    assert numpy.array_equal(x, expected["x"])
    assert kept == expected.samples


def test_motions_and_simulations_can_be_pickled_and_copied(model):
    motion = graze.simulate(model, periods=4, dense=True, extrema="x", sections="phase0", derivatives="x", minima=True)
    again = pickle.loads(pickle.dumps(motion))
    for table in ("samples", "contacts", "sections", "extrema", "minima", "derivatives", "summary"):
        assert getattr(again, table) == getattr(motion, table), table
    assert repr(again) == repr(motion)
    assert again.end_state == motion.end_state
    assert numpy.array_equal(again([0.1, 2.0]), motion([0.1, 2.0]))
    assert pickle.loads(pickle.dumps(again)).samples == motion.samples
    simulation = pickle.loads(pickle.dumps(graze.Simulation(model, extrema="x", tolerance=1e-8)))
    expected = graze.simulate(model, extrema="x", tolerance=1e-8)
    assert simulation.run().extrema == expected.extrema
    assert simulation.run().steps == expected.steps


def test_no_samples_and_no_contacts(model):
    motion = graze.simulate(model, periods=3, samples=0, events=[])
    assert len(motion.samples) == len(motion.contacts) == 0
    assert list(motion.samples) == ["time", "mode", "x", "v", "theta"]
    assert motion.sections is None
    assert motion.extrema is None
    assert motion.summary["contacts"][0] == 0
    assert motion.end_state == graze.simulate(model, periods=3).end_state
    assert len(graze.simulate(model, periods=3, events=["stop"]).contacts) > 0


def test_motions_end_by_themselves(model):
    """x' = x^2 from 1 goes to infinity at time 1."""
    escape = graze.Model(text='name = "escape"\n[states.x]\ninitial = 1\n[modes.only]\nrates = { x = "x^2" }\n')
    motion = graze.simulate(escape, time=5, samples=2)
    assert motion.ending == "singular"
    assert motion.regular
    assert motion.end_time == pytest.approx(1, abs=1e-9)
    motion = graze.simulate(model, time=1e9, samples=2, step_limit=1000)
    assert motion.ending == "step-limit"
    assert not motion.regular
    assert motion.detail != ""
    assert motion.steps == 1000
    assert motion.summary["ending"] == ["step-limit"]


def test_progress_may_raise(model):
    told = []

    def stop(fraction, time):
        told.append((fraction, time))
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        graze.simulate(model, periods=10_000_000, samples=0, progress=stop)
    assert len(told) == 1


def test_motions_are_drawn_as_by_the_program(model):
    matplotlib = pytest.importorskip("matplotlib")
    from matplotlib import pyplot

    axes = graze.simulate(model, periods=5, dense=True, at=[1.0, 2.0]).plot()
    assert len(axes) == 3  # two histories, and a portrait
    x = axes[0].lines[0].get_ydata()
    motion = graze.simulate(model, periods=5)
    assert min(x) == pytest.approx(motion["x"].min(), abs=1e-3)
    pyplot.close(axes[0].figure)
    axis = motion.plot(["energy"], [])
    pyplot.close("all")
    assert "energy" in numpy.atleast_1d(axis)[0].get_ylabel()
    with pytest.raises(graze.InputError):
        motion.plot(["nothing"])
    with pytest.raises(graze.InputError):
        motion.plot(portraits=[("x", "v", "theta")])
    assert matplotlib.__version__
    html = motion._repr_html_()
    assert html.startswith("<img")
    assert "contacts" in html


def test_tables_of_pandas_and_xarray(model):
    motion = graze.simulate(model, periods=2, samples=20)
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    frame = motion.to_pandas()
    assert isinstance(frame, pandas.DataFrame)
    assert frame["x"].tolist() == motion["x"].tolist()
    data = motion.to_xarray()
    assert isinstance(data, xarray.Dataset)
    assert data["x"].dims == ("time",)
    assert data["time"].values.tolist() == motion.t.tolist()


def test_wrong_arguments_are_told(model):
    for wrong in ({"time": -1}, {"time": 0}, {"time": math.nan}, {"time": math.inf}, {"time": "x"}, {"time": "2*"},
                  {"periods": 0.5}, {"periods": 0}, {"periods": 2**40}, {"periods": True}, {"samples": -1},
                  {"samples": 1}, {"samples": 10**8}, {"sections": "nowhere"}, {"tolerance": 1}, {"tolerance": math.nan},
                  {"order": 3}, {"order": 2**70}, {"state": [1]}, {"state": [1, 2, math.nan]}, {"state": {"y": 1}},
                  {"mode": "nowhere"}, {"every": 0}, {"every": "theta"}, {"samples": 5, "every": 0.1},
                  {"derivatives": "y"}, {"events": "nowhere"}, {"set": {"omega": math.nan}}, {"phase": "x"},
                  {"time": 1, "periods": 2}, {"skip": -1}, {"skip": 1, "after": 1}, {"quantities": "x +"},
                  {"state": {"x": 1}, "from_": {"x": 1}}, {"largest_step": -1}, {"step_limit": -1},
                  {"contacts_at_once": 0}):
        with pytest.raises(graze.InputError):
            graze.simulate(model, **wrong)
    for wrong in ({"tolerence": 1}, {"mode": 1}, {"time": object()}, {"set": 5}, {"state": "abc"}, {"sections": 5},
                  {"extrema": [1]}, {"phase": 2}, {"progress": 5}, {"state": 5}):
        with pytest.raises(TypeError):
            graze.simulate(model, **wrong)
    with pytest.raises(TypeError):
        graze.simulate("impact-oscillator")
    with pytest.raises(graze.InputError) as told:
        graze.simulate(model, periods=-1)
    assert str(told.value).startswith("periods: ")


@pytest.mark.parametrize("given, words", [
    ({"at": "x"}, "at: 'x' has other things than numbers"), ({"at": ["1", "2"]}, "at: .* other things than numbers"),
    ({"at": [True]}, "at: "), ({"at": [None]}, "at: "), ({"at": 5}, "0 dimensions"),
    ({"at": numpy.zeros(10_000_001)}, "at: there are 10000001 times; give 10000000 or fewer"),
    ({"state": 3}, "state: 3 .* list of numbers: of x, v, theta"), ({"state": {"x": "1"}}, "state, x"),
    ({"state": {"x": [1]}}, "state, x"), ({"time": [1]}, "time")])
def test_wrong_times_and_states_are_told_with_their_names(model, given, words):
    with pytest.raises(graze.InputError, match=words):
        graze.simulate(model, **given)


def test_dense_motions_take_numbers_only(model):
    motion = graze.simulate(model, time=1, dense=True)
    assert motion([[0, 1]]).shape == (1, 2, 3)
    for wrong in ("x", [None], [[1], [1, 2]]):
        with pytest.raises(graze.InputError, match="times: "):
            motion(wrong)


def test_derivatives_by_parameters_hold_the_initial_state():
    model = graze.Model("decay", states={"x": "2*a"}, parameters={"a": 1.0}, rates={"x": "-x"})
    motion = graze.simulate(model, time=1, derivatives="a")
    assert motion.derivatives["d_a"].tolist() == [0.0]


def test_samples_cannot_be_changed(model):
    motion = graze.simulate(model, time=1)
    x = motion["x"]
    with pytest.raises(ValueError, match="read-only"):
        x -= x.mean()
    motion.to_xarray()["x"].values[:] = 0
    motion.to_pandas()["x"].values[:] = 0
    assert abs(motion["x"]).max() > 0
