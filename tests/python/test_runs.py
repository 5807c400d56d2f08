import copy
import gc
import inspect
import math
import os
import pickle
import pydoc
import shutil
import subprocess
import sys
import tempfile
import threading

import numpy
import pytest

import graze


def program():
    """The program that is built beside the module, or another one of the same version."""
    beside = os.path.join(os.path.dirname(graze._graze.__file__), "..", "..", "bin", "graze")
    found = beside if os.path.exists(beside) else shutil.which("graze")
    if not found:
        pytest.skip("the program is not built")
    return found


def same_results(run, other):
    """Whether two runs have the same points, orbits and samples, to the last bit."""
    tables = ["points", "samples"]
    if isinstance(run, graze.Branch):
        tables = ["points", "segments", "multipliers", "half_multipliers", "eigenvalues", "minima", "end_values"]
    some, others = [run.table(what) for what in tables], [other.table(what) for what in tables]
    for one, another in zip(some, others):
        names = [name for name in one if name != "run"]  # names of runs may differ
        if names != [name for name in another if name != "run"]:
            return False
        if graze.Table(names, [one[n] for n in names]) != graze.Table(names, [another[n] for n in names]):
            return False
    return True


@pytest.fixture(scope="module")
def oscillator():
    return graze.Model.shipped("impact-oscillator")


@pytest.fixture(scope="module")
def branch(oscillator):
    rest = graze.orbit(oscillator, set={"omega": 4}, from_={"x": -0.07})
    return rest.follow(omega=(2.2, 4.5), direction="down")


@pytest.fixture(scope="module")
def impacting(branch):
    return branch["GR1"].switch()


@pytest.fixture(scope="module")
def testbed():
    return graze.Model.shipped("electromagnetic-testbed")


@pytest.fixture(scope="module")
def swing(tmp_path_factory):
    """A pendulum, a folder with the record of how it dies out, and its parameters there."""
    model = graze.Model(text="""name = "swing"
[parameters]
w = { value = 3, unit = "rad/s" }
zeta = 0.02
[states]
x = { initial = 0.1, unit = "rad" }
v = { initial = 0, unit = "rad/s" }
[modes.swing]
rates = { x = "v", v = "-w^2*x - 2*zeta*w*v" }
""")
    folder = tmp_path_factory.mktemp("records")
    motion = graze.simulate(model.with_(w=3.14, zeta=0.025), time=30, every=0.02)
    rows = [f"{t!r},{v!r}" for t, v in zip(motion.t.tolist(), motion["v"].tolist())]
    (folder / "release.csv").write_text("\n".join(["t [s], v [rad/s]", *rows]) + "\n")
    return model, folder, {"w": 3.14, "zeta": 0.025}


# Runs of all kinds


def test_a_sweep_equals_that_of_a_study(oscillator, tmp_path):
    swept = graze.sweep(oscillator, vary={"omega": (2.7, 2.8, 11)}, direction="both", cycles=80)
    (tmp_path / "s.toml").write_text(
        'name = "s"\nmodel = "impact-oscillator"\n[runs.a]\nkind = "sweep"\ncycles = 80\ndirection = "both"\n'
        'vary = { omega = { from = 2.7, to = 2.8, points = 11 } }\n')
    study = graze.run_study(tmp_path / "s.toml", output=tmp_path / "out")
    assert swept.status == "complete"
    assert len(swept.points) == 22
    assert same_results(swept, study["a"])
    assert sum(swept.labels().values()) == 22


def test_vary_takes_ranges_lists_arrays_and_dicts(oscillator):
    asked = [(2.7, 2.74, 3), [2.7, 2.72, 2.74], numpy.array([2.7, 2.72, 2.74]), {"from": 2.7, "to": 2.74, "step": 0.02}]
    runs = [graze.ensemble(oscillator, vary={"omega": values}, periods=2) for values in asked]
    assert all(numpy.allclose(run.points["omega"], [2.7, 2.72, 2.74], rtol=1e-15, atol=0) for run in runs)
    assert runs[1].samples == runs[2].samples


def test_the_study_of_the_mems_switch_is_repeated_by_calls():
    study = graze.run_study("mems-switch")
    model = graze.Model.shipped("mems-switch")
    trip = graze.ensemble(model, time=5000, sample={"impacts": {"contacts": ["stop"]}}, values=["v", "q"], vary={
        "V": {"offset": 0.2013662121541341, "from": 1e-8, "to": 1e-2, "points": 61, "scale": "log"}})
    free = graze.orbit(model, set={"V": 0.05}, from_={"q": 0, "v": 0, "theta": 0})
    no_impact = free.follow(V=(0.01, 0.4), direction="up")
    impacting = no_impact["GR1"].follow(V=(0.05, 0.4), direction="up", monitors={
        "max_q": {"maximum": "q", "bounds": (-1, 1)}, "max_v": {"maximum": "v"}})
    touches = no_impact["GR1"].curve(delta=(0.01, 0.9), V=(0.0001, 5), direction="both")
    folds = impacting["SN1"].curve(delta=(0.01, 0.9), V=(0.0001, 5), direction="both")
    for run, name in ((trip, "trip"), (free, "free"), (no_impact, "no_impact"), (impacting, "impacting"),
                      (touches, "touches_gap"), (folds, "folds_gap")):
        assert same_results(run, study[name]), name
    assert impacting.ends() == study["impacting"].ends() != {}
    assert all(report["status"] == "complete" for report in study.reports)


def test_from_an_orbit_to_the_branch_beyond_a_grazing(branch, impacting):
    grazing = branch["GR1"]
    assert grazing.type == "GR" and grazing.type_words == "grazing"
    # The amplitude 1/sqrt((1 - w^2)^2 + (2 zeta w)^2) of the linear oscillator equals the distance of the stop.
    model, square = branch.model, grazing.parameter**2
    zeta, sigma = model.parameters.zeta, model.parameters.sigma
    assert (1 - square) ** 2 + 4 * zeta**2 * square == pytest.approx(1 / sigma**2, rel=1e-9)
    assert impacting.status == "complete"
    assert impacting["EP1"].parameter == pytest.approx(grazing.parameter, rel=2e-3)
    assert impacting["PD1"].double().points["period"][0] == pytest.approx(2 * impacting["PD1"].period, rel=1e-2)
    assert [point.label for point in branch] == [point.label for point in branch.special]
    assert "GR1" in branch and "GR99" not in branch
    for wrong in ("GR99", 10_000, -10_000, 1.5, None):
        with pytest.raises(KeyError):
            branch[wrong]
    with pytest.raises(graze.InputError, match="no flip"):
        grazing.double()


def test_multipliers_of_a_linear_oscillator(branch):
    orbits, multipliers = branch.orbits(), branch.multipliers
    assert len(orbits) == len(branch) == len(multipliers)
    zeta = branch.model.parameters.zeta
    for orbit, row in zip(orbits, multipliers):
        assert row.tolist() == orbit.multipliers.tolist()
        growth = complex(-zeta, math.sqrt(1 - zeta**2)) * 2 * math.pi / orbit.parameter
        exact = numpy.exp(growth)
        assert sorted(abs(row - exact))[0] < 1e-10 and sorted(abs(row - exact.conjugate()))[0] < 1e-10
    assert branch[3] == orbits[3] and branch[-1].number == len(branch) - 1 and branch[1:3] == orbits[1:3]
    assert len({*orbits, branch[3]}) == len(orbits)


def test_a_branch_is_entered_at_a_value_and_along_its_motion(impacting):
    orbit = impacting.at(omega=2.6)
    assert orbit.parameters["omega"] == 2.6
    assert orbit.period == pytest.approx(2 * math.pi / 2.6, rel=1e-12)
    # A motion along the orbit comes back to where it was a period before.
    for state in ("x", "v"):
        early, late = (graze.simulate(orbit.model, time=share * orbit.period, samples=0).end_state for share in (0.3, 1.3))
        assert late[state] == pytest.approx(early[state], abs=1e-9)
    along = orbit.motion(50)
    assert along["t"][0] == 0 and along["t"][-1] == pytest.approx(orbit.period, rel=1e-12)
    assert along.x.min() >= orbit.parameters["sigma"] - 1e-9 or along.x.max() <= orbit.parameters["sigma"] + 1e-9
    for wrong in ({}, {"omega": 2.6, "e": 0.8}, {"omga": 2.6}):
        with pytest.raises(graze.InputError):
            impacting.at(**wrong)
    with pytest.raises(graze.InputError):
        orbit.motion(1)


def test_runs_start_from_runs(oscillator):
    swept = graze.sweep(oscillator, vary={"omega": [4.0, 4.1]}, from_={"x": -0.07})
    at = graze.follow(swept, at={"omega": 4.0}, omega=(2.2, 4.5), direction="down")
    written = graze.follow(oscillator, start={"run": swept, "point": 0}, omega=(2.2, 4.5), direction="down")
    assert same_results(at, written)
    assert at[0].parameter == 4.0
    onward = graze.ensemble(swept, at={"omega": 4.1}, periods=3)
    last = swept.points.record(1)
    assert onward.points["time"][0] == pytest.approx(3 * 2 * math.pi / 4.1, rel=1e-9)
    assert onward.points["end_x"][0] == pytest.approx(last["end_x"], abs=1e-8)
    with pytest.raises(graze.StudyError, match="without a start"):
        graze.sweep(oscillator, at={"omega": 4.0}, vary={"omega": [4.0]})


def test_a_ladder_leads_to_the_onset_of_chatter():
    model = graze.Model.shipped("impact-oscillator", zeta=0.5, omega=0.3, e=0.5, sigma=1.5)
    free = graze.follow(model, sigma=(0.1, 3), direction="down")
    ladder = free["GR1"].ladder(rungs=5)
    study = graze.run_study("""name = "ladder"
model = "impact-oscillator"
set = { zeta = 0.5, omega = 0.3, e = 0.5, sigma = 1.5 }
[runs.free]
kind = "continue"
along = { sigma = [0.1, 3] }
direction = "down"
[runs.ladder]
kind = "ladder"
start = { run = "free", point = "GR1" }
along = { sigma = [0.1, 3] }
rungs = 5
""")
    assert same_results(ladder, study["ladder"])
    grazings = [point.parameter for point in ladder if point.type == "GR"]
    assert len(grazings) == 5
    # Distances shrink by one ratio, and what is extrapolated by it lies near the limit that is computed.
    ratio = (grazings[4] - grazings[3]) / (grazings[3] - grazings[2])
    limit = grazings[4] + (grazings[4] - grazings[3]) * ratio / (1 - ratio)
    assert ladder["CH1"].parameter == pytest.approx(limit, abs=0.05 * abs(grazings[0] - limit))


def test_symmetric_orbits_and_their_twins(testbed):
    swept = graze.sweep(testbed, set={"f": 6.25}, vary={"V0": [4.83, 4.84]}, section="phase0", values=["v", "I"])
    three = graze.follow(swept, at={"V0": 4.84}, V0=(4.7, 5.3))
    assert three["SB1"].symmetric
    # A symmetry breaks where the map over half a period has a multiplier of 1.
    assert min(abs(abs(three["SB1"].half_multipliers) - 1)) < 1e-6
    lopsided = three["SB1"].switch(V0=(4.7, 5.3))
    orbit = lopsided[1]
    assert not orbit.symmetric and len(orbit.half_multipliers) == 0
    image = orbit.image()
    assert image.period == pytest.approx(orbit.period, rel=1e-12)
    assert numpy.allclose(image.multipliers, orbit.multipliers, atol=1e-6)
    assert not numpy.allclose(image.starts[0], orbit.starts[0], atol=1e-3)
    back = image.point.image()
    there, again = orbit.motion(2000), back.motion(2000)
    assert max(there.q) == pytest.approx(max(again.q), abs=1e-8) and min(there.I) == pytest.approx(min(again.I), abs=1e-5)
    assert max(image.motion(2000).I) == pytest.approx(-min(there.I), abs=1e-4)
    twin = orbit.twin(V0=(4.8, 4.9), steps=2)
    assert numpy.allclose(twin.multipliers[0], orbit.multipliers, atol=1e-6)


def test_the_microactuator_grazes_with_one_impact_more():
    model = graze.Model.shipped("impact-microactuator")
    rest = graze.orbit(model, set={"V": 0.01, "omega": 0.9189}, cycles=4000)
    free = rest.follow(V=(0.005, 1.1), direction="up", point_names={"GR1": "G-1"})
    one = free["GR1"].switch(direction="up")
    # Wilcox, Fig. 2.5, as the study of this name: orbits with no impact, one, and two.
    assert free["GR1"].name == "G-1" and free["G-1"] == free["GR1"]
    assert one["GR1"].parameter > 0 and "PD1" in free
    flips = free["PD1"].double(steps=3)
    assert flips.points["period"][0] == pytest.approx(2 * free["PD1"].period, rel=1e-3)
    assert one._record["coordinates"][0][0] == one.parameter == "V"


# Records


def test_parameters_are_found_from_records(swing, monkeypatch):
    model, folder, true = swing
    record = graze.record(files="release.csv", folder=folder)
    monkeypatch.chdir(folder)
    assert graze.record(files="rel*.csv").samples == record.samples
    assert len(record) == 1 and len(record.samples) == 1501 and record.units["v"] == "rad/s"
    found = graze.identify(model, record, what="decrement", gives={"natural_frequency": "w", "damping_ratio": "zeta"})
    assert found["w"] == pytest.approx(true["w"], rel=1e-6) and found["zeta"] == pytest.approx(true["zeta"], rel=1e-4)
    fit = graze.identify(model, [record], what="fit", unknowns=["w", "zeta"], parameters=found, readings=["v"],
                         known=["v"])
    assert fit["w"] == pytest.approx(true["w"], rel=1e-12) and fit["zeta"] == pytest.approx(true["zeta"], rel=1e-10)
    assert fit.estimates.record(0)["unit"] == "rad/s" and list(fit.values) == fit.estimates["name"]
    # The error is the root of the diagonal of the covariance.
    assert numpy.allclose(numpy.sqrt(numpy.diag(fit.covariance)), list(fit.errors.values()), rtol=1e-12)
    assert numpy.allclose(fit.covariance, fit.covariance.T)
    assert numpy.array_equal(fit.measured.v - fit.fitted.v, fit.residuals.v)
    assert abs(fit.residuals.v).max() < 1e-12 and fit.residuals.units["t"] == "s"
    assert numpy.allclose(fit.measured.v, record.samples["v"], rtol=0, atol=0)
    assert found.found_model.parameters.w == found["w"] and found.model.parameters.w == 3
    predicted = graze.ensemble(model, parameters=fit, time=10)
    assert predicted.model.parameters.w == fit["w"]
    with pytest.raises(KeyError, match="there are w, zeta"):
        fit["q"]


def test_a_virtual_bench_makes_records(testbed):
    asked = dict(set={"V0": 0, "w0": 96.4, "zeta": 0.0172}, from_={"q": -0.762e-3}, seed=1,
                 bench={"channels": {"v": {"value": "v", "noise": 2e-4}}, "rate": 1000, "time": 1, "repeats": 3})
    records = graze.record(testbed, **asked)
    assert len(records) == 3 and "3 records" in repr(records)
    assert records.samples == graze.record(testbed, **asked).samples
    found = graze.identify(testbed, records, what="decrement",
                           gives={"natural_frequency": "w0", "damping_ratio": "zeta"})
    assert abs(found["w0"] - 96.4) < 4 * found.errors["w0"]
    assert abs(found["zeta"] - 0.0172) < 4 * found.errors["zeta"]
    assert math.isnan(found.errors["natural_frequency_of_pairs"])
    place = found.estimates["name"].index("natural_frequency_of_pairs")
    assert numpy.isnan(found.covariance[place]).all() and not numpy.isnan(found.covariance[0, 0])


# What is kept, written and copied


def test_the_written_study_gives_the_program_the_same_numbers(impacting, swing, tmp_path):
    model, folder, _ = swing
    renamed = graze.Model(text=str(graze.Model.shipped("impact-oscillator")).replace(
        'name = "impact-oscillator"', 'name = "mine"'), e=0.75)
    swept = graze.sweep(renamed, vary={"omega": (2.7, 2.75, 6)}, cycles=80)
    record = graze.record(files="release.csv", folder=folder)
    found = graze.identify(model, record, what="decrement", gives={"natural_frequency": "w"})
    for run in (impacting, swept, found):
        path = run.write_study(tmp_path / run.name)
        subprocess.run([program(), "run", path, "--output", tmp_path / f"{run.name}-out", "--no-pictures", "--quiet"],
                       check=True)
        results = graze.read_results(tmp_path / f"{run.name}-out")
        assert same_results(run, results[run.name])
    assert results["identify1"].estimates == found.estimates
    assert sorted(os.listdir(tmp_path / "identify1")) == ["release.csv", "study.toml", "swing.toml"]
    assert sorted(os.listdir(tmp_path / impacting.name)) == ["study.toml"]
    assert impacting.study().count("[runs.") == 3  # those from which it follows, and no others


def test_results_outlive_what_made_them(oscillator, tmp_path):
    points = graze.sweep(oscillator, vary={"omega": [2.7, 2.75]}, cycles=80).points["omega"]
    assert points.tolist() == [2.7, 2.75]
    run = graze.sweep(oscillator, vary={"omega": [2.7, 2.75]}, cycles=80)
    folder = run._store.folder.path
    run.save(tmp_path / "kept.sqlite")
    with pytest.raises(graze.FileError):
        run.save(tmp_path / "kept.sqlite")
    del run
    gc.collect()
    assert not os.path.exists(folder)
    assert graze.read_results(tmp_path / "kept.sqlite")["sweep1"].points["omega"].tolist() == [2.7, 2.75]


def test_pickled_runs_and_points_can_be_followed_further(branch, impacting):
    doubled = impacting["PD1"].double()
    run = pickle.loads(pickle.dumps(impacting))
    assert type(run) is graze.Branch and same_results(run, impacting) and run.study() == impacting.study()
    assert same_results(run["PD1"].double(), doubled)
    point = pickle.loads(pickle.dumps(impacting["PD1"]))
    assert point == impacting["PD1"] and same_results(point.double(), doubled)
    one, other = pickle.loads(pickle.dumps([branch, impacting]))
    assert one._store is other._store
    orbit = pickle.loads(pickle.dumps(branch.at(omega=4)))
    assert isinstance(orbit, graze.Orbit) and orbit.parameters["omega"] == 4
    table = impacting.points
    assert pickle.loads(pickle.dumps(table)) == table


def test_copies_are_independent_and_leave_no_folders(impacting, tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    shallow, deep = copy.copy(impacting), copy.deepcopy(impacting)
    assert shallow._store is impacting._store and deep._store is not impacting._store
    assert same_results(deep, impacting) and same_results(shallow, impacting)
    assert copy.deepcopy(impacting["PD1"]) == impacting["PD1"]
    deep["PD1"].double(steps=1)
    gc.collect()
    assert len(os.listdir(tmp_path)) >= 1
    del shallow, deep
    gc.collect()
    assert not os.listdir(tmp_path)
    for _ in range(10):
        graze.ensemble(impacting.model, vary={"omega": [2.7]}, periods=1)
    gc.collect()
    assert not os.listdir(tmp_path)


def test_runs_of_different_files_are_used_together(branch, impacting, oscillator):
    swept = graze.sweep(oscillator, vary={"omega": (2.7, 2.8, 3)}, cycles=80)
    axes = swept.plot(over=graze.sweep(oscillator, vary={"omega": (2.7, 2.8, 2)}, cycles=80))
    assert len(numpy.atleast_1d(axes).ravel()) >= 1
    far = pickle.loads(pickle.dumps(impacting))
    axes = branch.plot(also=[far])
    assert len(numpy.atleast_1d(axes).ravel()[0].lines) > 0
    from matplotlib import pyplot

    pyplot.close("all")


def test_many_runs_of_one_branch_are_right(branch, monkeypatch):
    monkeypatch.setattr(graze._calls, "MOST_RUNS", 4)
    runs = [branch["GR1"].switch(steps=1) for _ in range(5)]
    assert all(same_results(one, runs[0]) for one in runs)
    assert runs[-1]._store is not branch._store  # one file has not too many runs
    assert runs[-1].study().count("[runs.") == 3


def test_threads_follow_from_one_branch_at_once(impacting):
    expected = impacting["PD1"].double()
    found = {}

    def follow(number):
        found[number] = impacting["PD1"].double(), len(impacting.points)

    threads = [threading.Thread(target=follow, args=(number,)) for number in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 3
    assert all(same_results(run, expected) and count == len(impacting.points) for run, count in found.values())


def test_functions_that_are_told_of_progress_may_read_and_compute(oscillator):
    told = []

    def tell(state):
        told.append(state["done"])
        if len(told) == 1:
            told.append(len(graze.ensemble(oscillator, vary={"omega": [2.7]}, periods=1).points))

    run = graze.sweep(oscillator, vary={"omega": (2.6, 2.9, 61)}, threads=1, progress=tell)
    assert len(run.points) == 61 and told[1] == 1


def test_an_interrupted_run_is_resumed_to_the_same_bits(oscillator):
    asked = dict(vary={"omega": (2.6, 2.9, 81)}, cycles=80, chaos_cycles=200)
    whole = graze.sweep(oscillator, **asked)
    with pytest.raises(graze.Interrupted) as told:
        graze.sweep(oscillator, progress=lambda state: state["done"] < 20, **asked)
    run = told.value.run
    assert run.status == "unfinished" and 20 <= len(run.points) < 81
    assert run.resume() is run and run.status == "complete"
    assert same_results(run, whole)


def in_another_process(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False,
                          env={**os.environ, "PYTHONPATH": os.path.dirname(os.path.dirname(graze.__file__))})


CHILD = """
import os, sys, graze
model = graze.Model.shipped("impact-oscillator")
free = graze.orbit(model, set={"omega": 4}, from_={"x": -0.07}).follow(omega=(2.2, 4.5), direction="down")
beyond = free["GR1"].switch()
print(free._store.folder.path)
"""


def test_forked_processes_read_and_compute_and_leave_the_files_alone():
    done = in_another_process(CHILD + """
child = os.fork()
if child == 0:
    points = beyond.points                # it reads what the parent has computed
    again = free["GR1"].switch()          # and goes on by itself
    assert again.points == points
    print(free._store.folder.path)
    sys.exit(0 if free._store.path.startswith(free._store.folder.path) else 3)
status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
assert status == 0, status
assert os.path.exists(free._store.folder.path)
assert free["GR1"].switch().points == beyond.points
""")
    assert done.returncode == 0, done.stderr
    kept = set(done.stdout.split())
    assert len(kept) == 2 and not any(os.path.exists(folder) for folder in kept)


@pytest.mark.parametrize("end", ["", "raise RuntimeError", "sys.exit(2)", "del free; x = beyond; y = [x]; y.append(y)"])
def test_no_folder_is_left_after_the_end(end):
    done = in_another_process(CHILD + end)
    folder = done.stdout.split()[0]
    assert os.path.basename(folder).startswith("graze-") and not os.path.exists(folder)


# Mistakes, and documentation


def test_runs_say_what_is_wrong(oscillator):
    with pytest.raises(graze.StudyError) as told:
        graze.sweep(oscillator, vary={"omega": (2.7, 2.8, 11)}, cycls=80)
    assert "cycles" in told.value.remedy
    assert told.value.file.startswith("sweep()")
    with pytest.raises(graze.StudyError) as told:
        graze.sweep(oscillator, vary={"omega": (2.7, 2.8, 11)}, cycles=-1)
    assert told.value.file == "sweep(), cycles"
    with pytest.raises(graze.StudyError) as told:
        graze.sweep(oscillator, vary={"omga": [1, 2]}, cycles=-1)
    assert [error.file for error in told.value.all] == ["sweep(), vary", "sweep(), cycles"]
    for wrong in ({"omega": object()}, {"omega": (1, 2)}, {"omega": {1: 2}}, {"omega": "\ud800"}, 5, {"omega": [None]}):
        with pytest.raises(graze.StudyError):
            graze.sweep(oscillator, vary=wrong)
    nested = []
    nested.append(nested)
    with pytest.raises(graze.StudyError, match="deeply"):
        graze.sweep(oscillator, vary={"omega": nested})


def test_no_message_speaks_of_a_study(oscillator, branch, testbed, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wrong = [
        (graze.StudyError, lambda: graze.sweep(oscillator)),
        (graze.StudyError, lambda: graze.sweep(oscillator, vary={"omega": [1, 2]}, kind="basin")),
        (graze.StudyError, lambda: graze.sweep(oscillator, vary={"omega": [1, 2]}, start="sweep1")),
        (graze.StudyError, lambda: graze.follow(oscillator, omga=(1, 2))),
        (graze.StudyError, lambda: graze.follow(testbed, start=branch["GR1"], V0=(1, 2))),
        (graze.RunFailed, lambda: graze.follow(branch, omega=(1, 2))),
        (graze.RunFailed, lambda: graze.follow(oscillator, omega=(7, 8))),
        (graze.StudyError, lambda: graze.record(files="nowhere.csv")),
        (graze.StudyError, lambda: graze.record(files="/nowhere.csv")),
        (graze.StudyError, lambda: graze.record()),
        (graze.StudyError, lambda: graze.identify(oscillator, branch, what="fit")),
        (graze.StudyError, lambda: branch["GR1"].curve(omega=(2, 4), sigma=(0.1, 1), onto="XX")),
        (graze.InputError, lambda: branch["GR1"].curve("omega", "sigma")),
        (graze.StudyError, lambda: branch["GR1"].follow(omega=(2, 4), cycles=5)),
    ]
    for number, (kind, call) in enumerate(wrong):
        with pytest.raises(kind) as told:
            call()
        text = str(told.value)
        assert "study" not in text and ".toml" not in text and "runs." not in text, (number, text)
    with pytest.raises(TypeError):
        graze.sweep("impact-oscillator", vary={"omega": [1, 2]})
    for threads in (0, True, 1.5):
        with pytest.raises(graze.InputError):
            graze.sweep(oscillator, vary={"omega": [1, 2]}, threads=threads)


def test_a_failed_run_is_kept_with_the_error(oscillator):
    with pytest.raises(graze.RunFailed) as told:
        graze.orbit(oscillator, cycles=1)
    assert told.value.run.status == "failed"
    assert "settle" in told.value.problem and "cycles" in told.value.remedy
    assert told.value.run.failure == f"{told.value.problem}; {told.value.remedy}"
    with pytest.raises(KeyError):
        told.value.run["GR1"]


@pytest.mark.parametrize("function, kind", [
    (graze.ensemble, "simulate"), (graze.sweep, "sweep"), (graze.basin, "basin"), (graze.orbit, "orbit"),
    (graze.equilibria, "equilibrium"), (graze.follow, "continue"), (graze.curve, "curve"), (graze.ladder, "ladder"), (graze.torus, "torus"), (graze.record, "record"),
    (graze.identify, "identify")])
def test_signatures_and_help_list_all_keys(function, kind):
    known = [{"from": "from_"}.get(key["name"], key["name"]) for key in graze._graze.study_keys(kind)]
    signature, text = inspect.signature(function), pydoc.render_doc(function, renderer=pydoc.plaintext)
    for name in known:
        if name not in ("kind", "model"):
            assert name in signature.parameters, name
            assert f"\n    {name}: " in text or f"\n        {name}: " in text, name
    assert f"graze.{function.__name__}" in repr(function) or function.__name__ in repr(function)
    assert pickle.loads(pickle.dumps(function)) is function


def test_arrays_of_points_cannot_be_changed(branch):
    with pytest.raises(ValueError, match="read-only"):
        branch["GR1"].starts[0, 0] = 7
    with pytest.raises(ValueError, match="read-only"):
        branch["GR1"].multipliers[0] = 7


def test_methods_of_points_list_their_keys(branch):
    signature = inspect.signature(branch["GR1"].follow)
    assert "self" not in signature.parameters and signature.parameters["steps"].default == 1000
    assert "cycles" not in signature.parameters  # of no use where a run starts from an orbit
    assert "steps: " in branch["GR1"].follow.__doc__
    assert graze.Point.follow.__name__ == "follow"


def test_one_orbit_says_what_it_lacks(oscillator, branch):
    rest = graze.orbit(oscillator, set={"omega": 4}, from_={"x": -0.07})
    for one in (rest, rest.point):
        assert not hasattr(one, "parameter") and one.parameters["omega"] == 4
        with pytest.raises(AttributeError, match="no parameter; its dict `parameters`"):
            one.parameter
    assert branch.parameter == "omega" and branch[0].parameter == 4
    with pytest.raises(AttributeError, match="nothing.*it has .*period"):
        rest.nothing
    with pytest.raises(graze.RunFailed) as told:
        graze.orbit(oscillator, set={"omega": 4}, from_={"x": -0.07}, cycles=1)
    none = told.value.run
    assert not hasattr(none, "period") and len(none) == 0
    with pytest.raises(graze.InputError, match=f"'{none.name}' has no orbit: ") as told:
        none.point
    assert told.value.remedy


def counted_calls(monkeypatch, of, name):
    """A list that gets an item for each call of a function of the compiled part."""
    calls, function = [], getattr(of, name)

    def counting(*arguments, **keys):
        calls.append(name)
        return function(*arguments, **keys)

    monkeypatch.setattr(of, name, counting if inspect.ismethoddescriptor(vars(of)[name]) else staticmethod(counting))
    return calls


def test_what_does_not_change_is_read_once(branch, monkeypatch, tmp_path):
    branch.save(tmp_path / "branch.sqlite")
    study = graze.read_results(tmp_path / "branch.sqlite")
    models = counted_calls(monkeypatch, graze._graze.Model, "parsed")
    runs = counted_calls(monkeypatch, graze._graze.ResultFile, "run")
    orbits = counted_calls(monkeypatch, graze._graze.ResultFile, "orbit")
    read = study[branch.name]
    assert len(runs) == 1
    assert [repr(one) for one in read.orbits()] == [repr(one) for one in branch.orbits()]
    assert read.units == branch.units and repr(read) == repr(branch)
    assert len(models) <= 1 and len(runs) <= 3
    rest = study[next(name for name in study if name != branch.name)]
    assert rest.kind == "orbit" and rest.period > 0
    orbits.clear()
    assert rest.point is rest.point and rest.multipliers is rest.point.multipliers and rest.stable
    assert orbits == []


def test_a_run_in_a_file_that_grows_is_read_anew(oscillator, tmp_path):
    text = """name = "grows"
model = "impact-oscillator"
[runs.a]
kind = "sweep"
cycles = 60
vary = { omega = { from = 2.7, to = 2.8, points = 400 } }
"""
    with pytest.raises(graze.Interrupted):
        graze.run_study(text, output=tmp_path, progress=lambda state: state["done"] < 5)
    run = graze.read_results(tmp_path)["a"]
    assert run.status == "unfinished"
    graze.run_study(text, output=tmp_path)
    assert run.status == "complete" and len(run.points) == 400


def test_unknown_keys_are_told_with_what_was_meant(oscillator, branch):
    orbit = graze.orbit(oscillator, set={"omega": 4}, from_={"x": -0.07})
    for call, words in ((lambda: orbit.follow(omga=(1, 2)), r"follow\(\), omga: .*did you mean 'omega'\?"),
                        (lambda: graze.sweep(oscillator, vary={"omega": [2.7]}, foo=None), r"sweep\(\), foo: "),
                        (lambda: graze.sweep(oscillator, vary={"omega": [2.7]}, rungs=None), r"sweep\(\), rungs: "),
                        (lambda: graze.sweep(oscillator, vary=[1]), "vary must be a dict, not a list; give a dict"),
                        (lambda: graze.follow(oscillator, along={"omega": {"from": 1}}), "must be a list, not a dict"),
                        (lambda: graze.sweep(oscillator, vary={"omega": {"from": 1}}), r'write \{"from": A, "to": B'),
                        (lambda: graze.follow(oscillator), r'give along=\{"PARAMETER": \[LEAST, GREATEST\]\}')):
        with pytest.raises(graze.StudyError, match=words) as told:
            call()
        assert len(str(told.value)) < 600


def test_a_number_of_points_may_be_a_whole_number_of_any_kind(oscillator):
    for points in (3, 3.0, numpy.float64(3)):
        assert len(graze.sweep(oscillator, vary={"omega": (2.7, 2.8, points)}, cycles=50).points) == 3
    with pytest.raises(graze.StudyError, match="whole number"):
        graze.sweep(oscillator, vary={"omega": (2.7, 2.8, 2.5)}, cycles=50)


def test_an_orbit_at_a_parameter_that_is_named_like_a_key():
    threads = graze.Parameter("threads", 1.0)
    x, v, phase = graze.states(x=1, v=0, phase=0)
    phase = graze.State("phase", 0, period="2*pi")
    model = graze.Model("m", states=[x, v, phase], parameters=[threads],
                        rates={x: v, v: -0.2 * v - threads * x + graze.cos(phase), phase: 1},
                        sections={"beat": {"state": phase, "value": 0}})
    branch = graze.orbit(model).follow(along={"threads": (0.5, 3)})
    for found in (branch.at({"threads": 2}), branch.at({"threads": 2}, threads=1)):
        assert found.parameters["threads"] == 2
    for wrong in ({}, 3, {"nowhere": 1}):
        with pytest.raises(graze.InputError):
            branch.at(wrong)


def test_a_picture_of_an_ensemble_says_which_motion_it_shows(oscillator):
    ensemble = graze.ensemble(oscillator, vary={"omega": [2.8, 2.7], "x": [0, -0.1]}, periods=3)
    figure = ensemble.figure()
    shown = figure.panels[0]["series"][0]["points"][-1]
    assert figure.title == "omega = 2.8, x = 0" and shown[1] == ensemble.points["end_x"][-1]
    assert ensemble.figure(title="mine").title == "mine" and ensemble.figure(at={"omega": 2.7}).title == ""


def test_values_of_a_list_are_taken_in_rising_order(oscillator):
    assert graze.sweep(oscillator, vary={"omega": [2.8, 2.7]}, cycles=50).points["omega"].tolist() == [2.7, 2.8]


def test_orbits_that_there_are_not(branch):
    for wrong in (-100, 10**6, 2**70, numpy.array(2.0), numpy.array([1.0, 2.0]), 1.5, True, "XX1", "\ud800"):
        with pytest.raises(KeyError) as told:
            branch[wrong]
        assert "-86" not in str(told.value) and wrong not in branch
    with pytest.raises(KeyError, match="there is no orbit -100"):
        branch[-100]


def test_no_folder_is_left_by_an_interruption_while_it_is_made(tmp_path, monkeypatch):
    from graze._output import OwnFolder

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    made = os.mkdir

    def interrupted(*arguments):
        made(*arguments)
        raise KeyboardInterrupt

    monkeypatch.setattr("os.mkdir", interrupted)
    with pytest.raises(KeyboardInterrupt):
        OwnFolder().path
    gc.collect()
    assert os.listdir(tmp_path) == []
    monkeypatch.setattr("secrets.token_hex", lambda size: "other")
    monkeypatch.setattr("os.mkdir", made)
    made(tmp_path / "graze-other")
    with pytest.raises(graze.FileError):
        OwnFolder().path
    gc.collect()
    assert os.listdir(tmp_path) == ["graze-other"]  # of another process


def test_an_atlas_explores_and_its_findings_are_tables(tmp_path):
    model = os.path.join(os.path.dirname(__file__), "..", "atlas", "truth", "cubic-map.toml")
    text = f"""name = "maps"
model = "{os.path.abspath(model)}"
[runs.map]
kind = "atlas"
vary = {{ a = {{ from = 0.5, to = 1.9, points = 15 }} }}
multiple = 1
starts = {{ x = [-2, 2] }}
draws = 8
"""
    (tmp_path / "maps.toml").write_text(text)
    study = graze.run_study(tmp_path / "maps.toml", output=tmp_path / "maps")
    points = study["map"].findings()
    assert list(points["name"]) == ["SN1", "PD1"]
    fold, flip = points["a"]
    assert fold == pytest.approx(1 + 3 * 0.05 ** (2 / 3), abs=1e-12)  # 27 b^2 = 4 (a - 1)^3, b = 0.1
    assert 27 * 0.1**2 == pytest.approx(4 * (flip + 1) * (2 - flip) ** 2, abs=1e-11)
    assert set(study["map"].findings("motions")["claim"]) == {"explained", "beyond limits", "not periodic"}
    assert "PD1" in [point.label for point in study["map.branch1"].special]
    with pytest.raises(graze.InputError, match="curves, points, branches, motions, left"):
        study["map"].findings("nothing")
    with pytest.raises(graze.InputError, match="there is no atlas"):
        study["map.branch1"].findings()
    program_says = subprocess.run([program(), "atlas", str(tmp_path / "maps"), "--what", "points", "--format", "csv"],
                                  capture_output=True, text=True, check=True)
    assert program_says.stdout.splitlines()[1].startswith("SN1,SN,fold,1.407")
