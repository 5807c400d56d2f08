import copy
import math
import pickle
import subprocess

import numpy
import pytest

import graze

from test_runs import program, same_results

pyplot = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture(scope="module")
def brusselator():
    """Its equilibrium (1, b/a) has the eigenvalues of trace b - 1 - a and determinant a; cycles begin at b = 1 + a."""
    return graze.Model("brusselator", parameters={"a": 1, "b": 1}, states={"x": 1, "y": 1},
                       rates={"x": "1 - (b + 1)*x + a*x^2*y", "y": "b*x - a*x^2*y"})


@pytest.fixture(scope="module")
def well():
    """A double well, which has a saddle between two stable equilibria for |h| < 2/sqrt(27)."""
    return graze.Model("well", parameters={"h": 0}, states={"x": 0.9, "v": 0},
                       rates={"x": "v", "v": "x - x^3 + h - 0.2*v"})


@pytest.fixture(scope="module")
def wells(well):
    return graze.equilibria(well, within={"x": (-3, 3), "v": (-1, 1)})


@pytest.fixture(scope="module")
def branch(brusselator):
    return graze.equilibria(brusselator, within={"x": (0, 10), "y": (0, 10)})[0].follow(b=(0.5, 3.5))


def eigenvalues_at(a, b):
    return numpy.roots([1, 1 + a - b, a])


def test_all_equilibria_in_a_box(wells):
    assert [round(one.starts[0, 0], 12) + 0.0 for one in wells] == [-1, 0, 1]
    assert [bool(one.stable) for one in wells] == [True, False, True]
    assert len(wells) == 3 and wells.eigenvalues.shape == (3, 2) and wells.multipliers.shape == (3, 0)
    saddle = wells["EP2"]
    assert saddle.eigenvalues == pytest.approx(numpy.sort(numpy.roots([1, 0.2, -1]))[::-1], rel=1e-12)
    assert saddle.eigenvalues.tolist() == wells.eigenvalues[1].tolist()
    assert saddle.period == 0 and len(saddle.multipliers) == 0
    assert "in the box are 3 equilibria, by proof" in list(wells.ends().values())[0]
    assert "3, 2 stable" in repr(wells) and "equilibrium, unstable" in repr(saddle)
    with pytest.raises(AttributeError, match="parameters"):
        wells.parameter


def test_one_equilibrium_near_a_state(well, wells):
    assert graze.equilibria(well)[0].starts[0, 0] == pytest.approx(1, abs=1e-12)
    assert graze.equilibria(well, from_={"x": -0.8})[0].starts[0, 0] == pytest.approx(-1, abs=1e-12)
    assert graze.equilibria(wells[1], set={"h": 0.1})[0].starts[0, 0] == pytest.approx(-0.101031257880101, abs=1e-12)


def test_branches_have_the_eigenvalues_of_the_closed_form(branch):
    for point, row in zip(branch.orbits(), branch.eigenvalues):
        exact = eigenvalues_at(1, point.parameter)
        # Double eigenvalues, as at b = 4, move with the square root of round-off.
        assert min(abs(row - exact[0])) < 1e-7 and min(abs(row - exact[1])) < 1e-7
        assert point.eigenvalues.tolist() == row.tolist()
    hopf = branch["HB1"]
    assert hopf.parameter == pytest.approx(2, rel=1e-10) and hopf.type_words == "Hopf point"
    assert "supercritical" in hopf.detail
    assert branch.at(b=1.5).eigenvalues == pytest.approx([complex(-0.25, s * math.sqrt(15) / 4) for s in (1, -1)])


def test_cycles_and_curves_begin_at_a_hopf_point(branch):
    cycles = branch["HB1"].switch()
    assert cycles[0].period == pytest.approx(2 * math.pi, rel=1e-2) and cycles[0].stable
    assert cycles.eigenvalues.shape == (len(cycles), 0) and len(cycles[0].eigenvalues) == 0
    curve = branch["HB1"].curve(a=(0.5, 3), b=(0.5, 5))
    assert curve.points["b"] == pytest.approx(1 + numpy.asarray(curve.points["a"]), rel=1e-9)


def test_a_branch_begins_with_an_equilibrium(brusselator):
    followed = graze.follow(brusselator, signature="equilibrium", b=(0.5, 3.5))
    assert followed["HB1"].parameter == pytest.approx(2, rel=1e-10)
    orbit = graze.orbit(brusselator, signature="equilibrium")
    assert orbit.eigenvalues == pytest.approx(eigenvalues_at(1, 1)) and orbit.period == 0


def test_the_motion_of_an_equilibrium_is_one_row(branch):
    motion = branch["HB1"].motion()
    assert len(motion) == 1 and motion["t"][0] == 0 and motion["end"][0] == "equilibrium"
    assert (motion["x"][0], motion["y"][0]) == pytest.approx((1, 2))
    assert branch["HB1"].certificate()


def test_equilibria_are_drawn_as_points(wells, branch):
    axes = wells.plot()
    drawn = [line.get_xydata() for line in axes.lines if line.get_marker() not in ("", "None", None)]
    assert sorted(round(x, 9) + 0.0 for xy in drawn for x, _ in xy) == [-1, 0, 1]
    assert branch["HB1"].plot() is not None
    for panel in branch["HB1"].plot(kind="history"):
        assert sum(len(line.get_xydata()) for line in panel.lines) == 1
    panels = {one["y_label"]: one for one in branch.figure(also=branch["HB1"].switch()).panels}
    of_period = numpy.concatenate([series["points"][:, 1] for series in panels["period"]["series"] if len(series["points"])])
    assert numpy.nanmin(of_period) > 6
    with pytest.raises(graze.InputError, match="eigenvalues"):
        branch["HB1"].plot_multipliers()
    pyplot.close("all")


def test_equilibria_can_be_copied_and_repeated(wells, tmp_path):
    for other in (copy.copy(wells), pickle.loads(pickle.dumps(wells)), wells.resume()):
        assert type(other) is graze.Equilibria and same_results(wells, other)
    study = wells.write_study(tmp_path / "study")
    subprocess.run([program(), "run", study, "--output", tmp_path / "out"], check=True, capture_output=True)
    read = graze.read_results(tmp_path / "out")
    assert type(read[wells.name]) is graze.Equilibria and same_results(wells, read[wells.name])


def test_mistakes_are_told_as_those_of_the_call(well):
    with pytest.raises(graze.StudyError, match=r"equilibria\(\), within: the model has no state 'z'"):
        graze.equilibria(well, within={"z": (0, 1)})
    with pytest.raises(graze.RunFailed, match="no range of state 'v'"):
        graze.equilibria(well, within={"x": (0, 1)})
    with pytest.raises(graze.RunFailed, match="no equilibrium in the box"):
        graze.equilibria(well, within={"x": (2, 3), "v": (-1, 1)})
    with pytest.raises(graze.StudyError, match="belongs to \"equilibrium\""):
        graze.orbit(well, within={"x": (2, 3)})
