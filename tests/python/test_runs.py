import os
import pickle

import numpy
import pytest

import graze


@pytest.fixture(scope="module")
def oscillator():
    return graze.Model.shipped("impact-oscillator")


@pytest.fixture(scope="module")
def branch(oscillator):
    rest = graze.orbit(oscillator, set={"omega": 4}, from_={"x": -0.07})
    return rest.follow(omega=(2.2, 4.5), direction="down")


def test_a_sweep_equals_that_of_a_study(oscillator, tmp_path):
    swept = graze.sweep(oscillator, vary={"omega": (2.7, 2.8, 11)}, direction="both", cycles=80)
    (tmp_path / "s.toml").write_text(
        'name = "s"\nmodel = "impact-oscillator"\n[runs.a]\nkind = "sweep"\ncycles = 80\ndirection = "both"\n'
        'vary = { omega = { from = 2.7, to = 2.8, points = 11 } }\n')
    study = graze.run_study(tmp_path / "s.toml", output=tmp_path / "out")
    assert swept.status == "complete"
    assert len(swept.points) == 22
    assert swept.points == study["a"].points
    assert swept.samples == study["a"].samples


def test_from_an_orbit_to_the_branch_beyond_a_grazing(branch):
    grazing = branch["GR1"]
    assert grazing.type == "GR"
    # The amplitude 1/sqrt((1 - w^2)^2 + (2 zeta w)^2) of the linear oscillator equals the distance of the stop.
    model, square = branch.model, grazing.parameter**2
    zeta, sigma = model.parameters.zeta, model.parameters.sigma
    assert (1 - square) ** 2 + 4 * zeta**2 * square == pytest.approx(1 / sigma**2, rel=1e-9)
    impacting = grazing.switch()
    assert impacting.status == "complete"
    assert impacting["EP1"].parameter == pytest.approx(grazing.parameter, rel=2e-3)
    assert impacting["PD1"].double().points["period"][0] == pytest.approx(2 * impacting["PD1"].period, rel=1e-2)
    assert [point.label for point in branch] == [point.label for point in branch.special]
    with pytest.raises(KeyError):
        branch["GR99"]


def test_runs_say_what_is_wrong(oscillator):
    with pytest.raises(graze.StudyError) as told:
        graze.sweep(oscillator, vary={"omega": (2.7, 2.8, 11)}, cycls=80)
    assert "cycles" in told.value.remedy
    assert told.value.file.startswith("sweep()")
    with pytest.raises(graze.StudyError) as told:
        graze.sweep(oscillator, vary={"omega": (2.7, 2.8, 11)}, cycles=-1)
    assert told.value.file == "sweep(), cycles"
    with pytest.raises(graze.StudyError):
        graze.sweep(oscillator, vary={"omega": object()})
    with pytest.raises(graze.StudyError):
        graze.sweep(oscillator, vary={"omega": (1, 2)})


def test_results_outlive_what_made_them(oscillator, tmp_path):
    points = graze.sweep(oscillator, vary={"omega": [2.7, 2.75]}, cycles=80).points["omega"]
    assert points.tolist() == [2.7, 2.75]
    run = graze.sweep(oscillator, vary={"omega": [2.7, 2.75]}, cycles=80)
    folder = run._store.folder
    run.save(tmp_path / "kept.sqlite")
    del run
    assert not os.path.exists(folder)
    assert graze.read_results(tmp_path / "kept.sqlite")["sweep1"].points["omega"].tolist() == [2.7, 2.75]
