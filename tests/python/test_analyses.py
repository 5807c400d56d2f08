"""Analyses of special points: against closed forms, other routes of the library, and the program where it is built."""

import copy
import json
import math
import os
import pathlib
import pickle
import signal
import subprocess
import threading
import time

import numpy
import pytest

import graze

PROGRAM = pathlib.Path(graze._graze.__file__).parents[2] / "bin" / "graze"
needs_program = pytest.mark.skipif(not PROGRAM.exists(), reason="the program is not built beside the module")


@pytest.fixture(scope="module")
def switch(tmp_path_factory):
    return graze.run_study("mems-switch", output=tmp_path_factory.mktemp("switch"), only=["free", "no_impact"])


@pytest.fixture(scope="module")
def touch(switch):
    return switch["no_impact"]["GR1"]


@pytest.fixture(scope="module")
def actuator(tmp_path_factory):
    return graze.run_study("microactuator", output=tmp_path_factory.mktemp("actuator"), only=["rest", "no_impact"])


@pytest.fixture(scope="module")
def testbed(tmp_path_factory):
    return graze.run_study("electromagnetic-testbed", output=tmp_path_factory.mktemp("testbed"),
                           only=["free_8Hz", "no_impact_8Hz", "impacting_8Hz"])


@pytest.fixture(scope="module")
def oscillator(tmp_path_factory):
    """The impact oscillator, without and with one impact."""
    rest = graze.orbit(graze.Model.shipped("impact-oscillator"), set={"omega": 4}, from_={"x": -0.07})
    free = rest.follow(omega=(2.2, 4.5), direction="down")
    path = tmp_path_factory.mktemp("oscillator") / "results.sqlite"
    free["GR1"].switch().save(path)
    return graze.read_results(path)


def grazing_of(study):
    """The first grazing of the first branch that has one."""
    return next(point for name in study if isinstance(study[name], graze.Branch) for point in study[name].special
                if point.type == "GR")


# Grazing


def test_the_map_of_a_linear_oscillator_has_its_closed_form(oscillator):
    point = grazing_of(oscillator)
    found = point.grazing()
    zeta, omega, e = (point.parameters[name] for name in ("zeta", "omega", "e"))
    # Between contacts the oscillator is linear: a difference decays as its own motion over one period of the drive.
    period, own = 2 * math.pi / omega, math.sqrt(1 - zeta**2)
    decay, angle = math.exp(-zeta * period), own * period
    assert found["cycle"] == pytest.approx(period, rel=1e-12)
    assert found.multiplier == pytest.approx(decay, rel=1e-9)
    assert found.restitution == pytest.approx(e, rel=1e-12)
    assert found.direction_v == pytest.approx(-(1 + e), rel=1e-12)  # the stop is at positive x
    # A change of the velocity by (1 + e) s moves the oscillator k periods later by the impulse response.
    sign = numpy.sign(found.projections[0]) * numpy.sign(math.sin(angle))
    response = [math.exp(-zeta * k * period) * math.sin(own * k * period) / own * (1 + e) for k in range(1, 9)]
    assert found.projections == pytest.approx(sign * numpy.array(response), rel=1e-8, abs=1e-12)
    assert found.cycle_map.projections(8) == pytest.approx(found.projections, rel=1e-12)


def test_what_follows_from_the_map(touch):
    found = touch.grazing(verify=True)
    assert found.verdict == "lost" and found.trial == "agreed" and found.contacts_when == "above"
    assert found.next_contact == 1 and found.reason == ""
    # The first negative projection gives the growth: v' = (2 a |g P B| v)^(1/2), and the jump is (1 + e) v.
    growth = math.sqrt(2 * found.acceleration * -found.projections[0])
    assert found.growth == pytest.approx(growth, rel=1e-12)
    assert found.jump_growth == pytest.approx(found.growth * math.sqrt(1 + found.restitution), rel=1e-12)
    assert found.speed_factor == pytest.approx(math.sqrt(2 * found.acceleration * -found.clearance_rate), rel=1e-12)
    assert len(found.trial_motions) == 2 and all(found.trial_motions["contacts"] > 0)
    assert "agreed" in repr(found.facts.array) and "lost" in repr(found) and "lost" in found._repr_html_()
    assert found.to_pandas().shape == (len(found.facts), 3)
    assert {"verdict", "cycle_map"} <= set(dir(found)) and dict(found)["verdict"] == "lost"
    assert len(touch.grazing().trial_motions) == 0 and "trial" not in touch.grazing()


def test_a_map_maps(touch):
    found = touch.grazing()
    cycle = found.cycle_map
    assert cycle.active == ("q", "v", "theta") and cycle.order == "square-root"
    assert max(abs(numpy.linalg.eigvals(cycle.matrix))) == pytest.approx(found.multiplier, rel=1e-9)
    # Without contact the map is linear; with a small one, to leading order, P (x + B s).
    state = 1e-9 * cycle.scales
    assert cycle.image(state, 1.0) == pytest.approx(cycle.matrix @ state, rel=1e-12)
    clearance = -1e-16
    speed = math.sqrt(-2 * cycle.acceleration * clearance)
    expected = cycle.matrix @ (cycle.impact * speed)
    assert cycle.image(0 * state, clearance) == pytest.approx(expected, rel=1e-6)
    assert cycle.gradient @ expected == pytest.approx(found.projections[0] * speed, rel=1e-9)
    motion = cycle.motion(-1e-6, cycles=100)
    assert motion.largest > 0 and motion.contacts > 0
    for wrong in (lambda: cycle.image([1.0], 0), lambda: cycle.image(state, "x"), lambda: cycle.motion(math.nan),
                  lambda: cycle.projections(-1), lambda: cycle.motion(-1e-6, cycles=0)):
        with pytest.raises(graze.InputError):
            wrong()


# Trips


def test_predicted_and_simulated_trips_agree(touch):
    trips = touch.trip(overshoot="1e-4:1e-8", until="end")
    assert trips["overshoot"].tolist() == [1e-4, 1e-5, 1e-6, 1e-7, 1e-8]
    # Speeds go with the root of the overshoot; the first contact comes before the new orbit is reached.
    factor = trips["first_speed"] / trips["overshoot"] ** 0.5
    assert factor == pytest.approx([factor[0]] * 5, rel=1e-12) and factor[0] < touch.grazing().speed_factor
    # By the map and then by simulation, and by simulation alone.
    assert trips["end_time"] == pytest.approx(trips["simulated_time"], rel=1e-3)
    assert set(trips["ending"]) <= {"singular", "terminal"}
    assert not trips.unfinished and len(trips) == trips.wanted == 5
    assert (trips.kind, trips.parameter, trips.side) == ("touch", "V", 1) and trips.value == touch.parameter
    # The trip that the map continues ends as the model itself does, simulated beyond the touch.
    model = touch.model
    model.parameters.V = touch.parameter + 1e-4
    motion = graze.simulate(model, time=100)
    assert motion.ending in ("singular", "terminal")
    usual = touch.trip()
    assert len(usual) == 10 and usual["overshoot"][0] == pytest.approx(1e-3) and usual.end.startswith("speed")


def test_trips_say_which_have_no_end(touch):
    trips = touch.trip(overshoot=1e-6, until=("q", 5), cycles=3)
    assert len(trips) == 1 and len(trips.unfinished) == 1
    assert "give more cycles, or another end by until" in trips.unfinished[0]
    assert math.isnan(trips["end_time"][0]) and trips["ending"] == ["end-time"]
    assert "1 unfinished" in repr(trips)


def test_a_fold_is_passed_in_the_time_of_its_normal_form(testbed):
    fold = testbed["impacting_8Hz"]["SN1"]
    trips = fold.trip(overshoot="-1e-4:-1e-7", cycles=20_000)
    assert trips.kind == "fold" and trips.side == -1 and trips.speed is None
    cycles = math.pi / numpy.sqrt(trips.coefficient * abs(trips.rate * trips["overshoot"]))
    assert trips["cycles"] == pytest.approx(cycles, rel=1e-12)
    assert trips["time"] == pytest.approx(cycles * trips.cycle, rel=1e-12)
    # Between the gates, the nearer to the fold the more exactly.
    known = ~numpy.isnan(trips["simulated_cycles"])
    assert known.sum() >= 3
    departures = abs(trips["simulated_cycles"] / trips["gate_cycles"] - 1)[known]
    assert departures[-1] < 0.01 and departures[-1] < departures[0]


def test_two_points_side_by_side(touch, testbed):
    fold = testbed["impacting_8Hz"]["SN1"]
    both = touch.trip(overshoot=[1e-3, 1e-4], beside=fold, cycles=3000)
    assert both["cycles"].tolist() == touch.trip(overshoot=[1e-3, 1e-4], cycles=3000)["cycles"].tolist()
    assert both["beside_cycles"].tolist() == fold.trip(overshoot=[-1e-3, -1e-4], cycles=3000)["cycles"].tolist()


def test_ramps(touch):
    ramps = touch.trip(ramp=[1e-5, 1e-6])
    assert ramps["delay"] == pytest.approx(ramps["value"] - touch.parameter, rel=1e-12)
    assert ramps["value"] == pytest.approx(ramps["from"] + ramps["rate"] * ramps["time"], rel=1e-12)
    assert ramps["delay_cycles"] == pytest.approx(ramps["delay"] / (ramps["rate"] * ramps.cycle), rel=1e-12)
    given = touch.trip(ramp=1e-5, at=0.2)
    assert given["from"].tolist() == [0.2] and given["delay"] == pytest.approx(ramps["delay"][:1], rel=0.3)


def test_waves_trip_from_an_amplitude_on(touch):
    waves = touch.trip(wave=(0.001, 0.002, 0.003), at=0.199)
    assert waves["trips"] == ["no", "no", "yes"]
    assert numpy.isnan(waves["time"][:2]).all() and waves["time"][2] > 0
    faster = touch.trip(wave=0.003, at=0.199, wave_period=5, cycles=50)
    assert faster["trips"] == ["no"] and not faster.unfinished


def test_noise_does_not_depend_on_threads(touch):
    asked = dict(noise=[0.002, 0.004], at=0.199, motions=40, seed=3, cycles=50)
    one, several = touch.trip(threads=1, **asked), touch.trip(threads=3, **asked)
    assert one.table == several.table
    trips, motions = one["trips"], one["motions"]
    assert one["probability"] == pytest.approx(trips / motions, rel=1e-15) and (motions == 40).all()
    assert trips[0] <= trips[1]
    # Wilson's interval, with the 97.5 % quantile of the normal distribution.
    z, p, n = 1.959963984540054, trips / motions, motions
    half = z / (1 + z * z / n) * numpy.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    assert one["low"] == pytest.approx(middle - half, abs=1e-12) and one["high"] == pytest.approx(middle + half, abs=1e-12)
    assert touch.trip(**{**asked, "seed": 4}).table != one.table


# Tolerance


def test_derivatives_of_a_grazing_have_their_closed_form(oscillator):
    point = grazing_of(oscillator)
    found = point.tolerance()
    assert found.parameter == "omega" and found.value == pytest.approx(point.parameter, rel=1e-12)
    # The amplitude A/sqrt((1 - w^2)^2 + (2 zeta w)^2) of the linear oscillator equals the distance of the stop.
    w, zeta, sigma, amplitude = found.value, *(point.parameters[name] for name in ("zeta", "sigma", "amplitude"))
    square = (1 - w**2) ** 2 + 4 * zeta**2 * w**2
    assert square == pytest.approx((amplitude / sigma) ** 2, rel=1e-9)
    by_omega = -4 * w * (1 - w**2) + 8 * zeta**2 * w
    assert found["zeta"] == pytest.approx(-8 * zeta * w**2 / by_omega, rel=1e-7)
    assert found["sigma"] == pytest.approx(-2 * amplitude**2 / sigma**3 / by_omega, rel=1e-7)
    assert found["e"] == 0
    relative = dict(zip(found.derivatives["parameter"], found.derivatives["relative"]))
    assert relative["sigma"] == pytest.approx(found["sigma"] * sigma / w, rel=1e-12)
    # At other values of the parameters.
    moved = found(sigma=1.1 * sigma)
    square = (1 - moved.value**2) ** 2 + 4 * zeta**2 * moved.value**2
    assert moved.admissible and square == pytest.approx((amplitude / (1.1 * sigma)) ** 2, rel=1e-9)
    assert found().value == pytest.approx(found.value, rel=1e-12)
    with pytest.raises(graze.InputError):
        found.plot()


def test_a_yield_over_devices(touch):
    found = touch.tolerance(vary={"delta": "1%", "omega": (0.002, "uniform")}, within=(0.19, 0.21), devices=400, threads=1)
    devices = found.devices
    assert found.confidence == 0.95 and found.seed == 1 and found.problems == {}
    assert len(devices) == 400 and set(devices["outcome"]) == {"found"}
    assert found.mean == pytest.approx(devices["value"].mean(), rel=1e-12)
    assert found.deviation == pytest.approx(devices["value"].std(ddof=1), rel=1e-9)
    assert found.within == ((0.19 <= devices["value"]) & (devices["value"] <= 0.21)).mean()
    low, high = found.interval("within")
    assert low < found.within < high
    linear = math.hypot(found["delta"] * 0.006, found["omega"] * 0.002 / math.sqrt(3))
    assert found.linear_deviation == pytest.approx(linear, rel=1e-12)
    assert found.largest_departure == pytest.approx(abs(devices["value"] - devices["linear"]).max(), rel=1e-12)
    assert sum(share for share in found.derivatives["share"] if share == share) == pytest.approx(1)
    several = touch.tolerance(vary={"delta": "1%", "omega": (0.002, "uniform")}, within=(0.19, None), devices=400, threads=3)
    assert several.devices == devices
    assert several.within == (devices["value"] >= 0.19).mean()
    assert "400 devices" in repr(found) and found.unit == ""
    assert touch.tolerance(parameter="delta")["V"] == pytest.approx(1 / found["delta"], rel=1e-9)


# Ladders, orbits, points


def test_a_ladder_leads_to_chatter(actuator):
    point = actuator["no_impact"]["GR1"]
    found = point.chatter(rungs=5)
    values = found[found.parameter]
    assert len(found) == 5 and values[0] == point.parameter and not found.ends and not found.no_limit
    distances = numpy.diff(values)
    assert found["lambda"][:3] == pytest.approx(distances[1:] / distances[:-1], rel=1e-12)
    # The two ways agree within their errors.
    assert abs(found.limit - found.extrapolated) <= 3 * (found.limit_error + found.extrapolated_error)
    # e (1 + 2 rho) = rho^2 (2 + rho), and the ratio is rho^5/e^2.
    rho = [root.real for root in numpy.roots([1, 2, -2 * found.restitution, -found.restitution])
           if abs(root.imag) < 1e-12 and 0 < root.real < 1]
    assert found.ratio == pytest.approx(rho[0] ** 5 / found.restitution**2, rel=1e-9)
    # The run of the same ladder has the same grazings, folds and flips, and the onset of chatter.
    run = point.ladder(rungs=3)
    places = {kind: [one.parameter for one in run.special if one.type == kind] for kind in ("GR", "SN", "PD", "CH")}
    assert places["GR"] == values[:3].tolist()
    assert places["SN"] == found["fold"][:2].tolist() and places["PD"] == found["flip"][:2].tolist()
    assert places["CH"] == pytest.approx([found.limit], rel=1e-10)
    assert f"{found.limit:.12g}" in repr(found) and found.to_pandas().shape == (5, 5)
    with pytest.raises(AttributeError):
        found.plot()


def test_a_motion_goes_along_the_orbit(touch):
    motion = touch.motion(60, quantities=["q^2 + v^2", "gap"])
    assert list(motion)[:6] == ["t", "q", "v", "theta", "q^2 + v^2", "gap"]
    assert motion["q^2 + v^2"] == pytest.approx(motion.q**2 + motion.v**2, rel=1e-14)
    assert motion["gap"] == pytest.approx(1 - motion.q, rel=1e-14)
    assert motion.t[0] == 0 and motion.t[-1] == pytest.approx(touch.period, rel=1e-12)
    assert sorted(set(motion["segment"].tolist())) == [1, 2] and set(motion["end"]) == {"switch_on", "switch_off"}
    assert min(motion["q"]) >= -touch.parameters["delta"] - 1e-9  # touches, at the stop
    certificate = touch.certificate()
    assert certificate.segments["duration"].tolist() == touch.durations.tolist()
    assert certificate.segments["approach_speed"].tolist() == touch.approach_speeds.tolist()
    stops = [value for event, value in zip(certificate.minima["event"], certificate.minima["value"]) if event == "stop"]
    assert min(map(abs, stops)) < 1e-9
    assert certificate.signature in repr(certificate) and certificate.symmetry == ""


def test_points_of_results(switch, touch):
    found = graze.points(switch, type="gr")
    assert found["label"] == ["GR1"] and found["V"].tolist() == [touch.parameter]
    every = graze.points(switch["no_impact"], all=True)
    assert len(every) == len(switch["no_impact"].points) and set(every["run"]) == {"no_impact"}
    assert set(graze.points(switch)["run"]) == {"free", "no_impact"}
    assert len(graze.points(switch, run=["no_impact"], type=("GR", "SN"))) == 1
    for wrong in (dict(type="XX"), dict(run="other")):
        with pytest.raises(graze.InputError):
            graze.points(switch, **wrong)
    with pytest.raises(TypeError):
        graze.points("switch")


# Manners


def interrupted(compute, after=0.3):
    """What is kept, and how long it took to end."""
    sent = []

    def send():
        time.sleep(after)
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=send)
    thread.start()
    with pytest.raises(graze.Interrupted) as told:
        compute()
    ended = time.perf_counter()
    thread.join()
    return told.value.run, ended - sent[0]


@pytest.mark.parametrize("name, compute", [
    ("yield", lambda touch: touch.tolerance(vary={"delta": "1%"}, devices=300_000)),
    ("noise", lambda touch: touch.trip(noise=[0.0, 1e-5], at=0.199, motions=100, cycles=1_000_000)),
    ("wave", lambda touch: touch.trip(wave=[0.003, 1e-5], at=0.199, cycles=10_000_000)),
])
def test_what_is_interrupted_ends_soon(touch, name, compute):
    kept, seconds = interrupted(lambda: compute(touch))
    assert seconds < 0.5  # 0.1 s on a machine that has nothing else to do
    if name == "yield":
        assert 0 < len(kept.devices) < 300_000 and kept.mean > 0
    elif name == "wave":
        assert kept["trips"] == ["yes"] and kept.wanted == 2


def test_progress_may_stop(touch):
    seen = []

    def tell(state):
        seen.append(state)
        return state["done"] == 0

    with pytest.raises(graze.Interrupted) as told:
        touch.tolerance(vary={"delta": "1%"}, devices=300_000, progress=tell)
    assert seen[-1]["points"] == 300_000 and 0 < seen[-1]["done"] <= len(told.value.run.devices) < 300_000

    def fail(state):
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        touch.trip(noise=0.001, at=0.199, motions=100_000, progress=fail)


def test_many_threads_may_ask_the_same_point(touch):
    tolerance, alone = touch.tolerance(), touch.trip(overshoot=1e-3).table
    values = [tolerance(delta=0.6 + 0.01 * k).value for k in range(4)]
    wrong = []

    def ask(k):
        for _ in range(5):
            if touch.trip(overshoot=1e-3).table != alone or tolerance(delta=0.6 + 0.01 * k).value != values[k]:
                wrong.append(k)

    threads = [threading.Thread(target=ask, args=(k,)) for k in range(4)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert not wrong


def test_figures_are_those_of_the_program(touch, testbed):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    trips = touch.trip(overshoot="1e-3:1e-6", until="end")
    points = numpy.concatenate([one["points"] for one in trips.figure().panels[0]["series"] if len(one["points"])])
    assert set(trips["overshoot"]) <= set(points[:, 0].tolist())
    assert set(trips["end_time"]) <= set(points[:, 1].tolist())
    results = [trips, touch.trip(ramp=[1e-4, 1e-5]), touch.trip(wave=[0.003], at=0.199),
               touch.trip(noise=[0.003], at=0.199, motions=20),
               touch.tolerance(vary={"delta": "1%"}, devices=60, within=(0.199, None)),
               touch.trip(overshoot=1e-3, beside=testbed["impacting_8Hz"]["SN1"], cycles=3000)]
    for result in results:
        axes = result.plot()
        assert axes.get_xlabel() and axes.lines
        assert "<img" in result._repr_html_()
        pyplot.close("all")
    with pytest.raises(graze.InputError):
        touch.trip(overshoot=0, disturbance={"q": 1e-3}).plot()
    with pytest.raises(graze.InputError):
        touch.tolerance(vary={"e": "1%"}, devices=10).plot()  # all alike


def test_results_can_be_copied_and_stored(touch, actuator):
    for result in (touch.grazing(), touch.trip(overshoot=1e-3), touch.tolerance(vary={"delta": "1%"}, devices=20),
                   actuator["no_impact"]["GR1"].chatter(rungs=2)):
        for other in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
            assert repr(other) == repr(result)
            mine, its = (next(v for v in vars(one).values() if isinstance(v, graze.Table)) for one in (result, other))
            assert mine == its
            with pytest.raises((graze.OrderError, AttributeError)):
                other.plot()


WRONG = [
    (graze.InputError, "parameter", lambda p: p.grazing(parameter="nothing")),
    (graze.InputError, "parameter", lambda p: p.grazing(parameter=3)),
    (TypeError, "", lambda p: p.grazing(verfy=True)),
    (TypeError, "", lambda p: p.grazing("V")),
    (graze.InputError, "overshoot", lambda p: p.trip(overshoot="a lot")),
    (graze.InputError, "overshoot", lambda p: p.trip(overshoot=[])),
    (graze.InputError, "overshoot", lambda p: p.trip(overshoot=-1e-3)),
    (graze.InputError, "overshoot", lambda p: p.trip(overshoot=math.nan)),
    (graze.InputError, "overshoot", lambda p: p.trip(overshoot="1e-2:-1e-3")),
    (graze.InputError, "overshoot", lambda p: p.trip(overshoot=[None])),
    (graze.InputError, "overshoot", lambda p: p.trip(overshoot={"V": 1})),
    (graze.InputError, "overshoot", lambda p: p.trip(overshoot=[1e-3] * 1001)),
    (graze.InputError, "until", lambda p: p.trip(until="q")),
    (graze.InputError, "until", lambda p: p.trip(until="nothing=1")),
    (graze.InputError, "until", lambda p: p.trip(until=("q",))),
    (graze.InputError, "until", lambda p: p.trip(until="end", greatest_speed=1)),
    (graze.InputError, "greatest_speed", lambda p: p.trip(greatest_speed=-1)),
    (graze.InputError, "cycles", lambda p: p.trip(cycles=0)),
    (graze.InputError, "cycles", lambda p: p.trip(cycles=2.5)),
    (graze.InputError, "disturbance", lambda p: p.trip(disturbance={"x": 1})),
    (graze.InputError, "disturbance", lambda p: p.trip(disturbance=1)),
    (graze.InputError, "beside", lambda p: p.trip(beside="SN1")),
    (graze.InputError, "at", lambda p: p.trip(at=0.199)),
    (graze.InputError, "at", lambda p: p.trip(wave=0.01)),
    (graze.InputError, "at", lambda p: p.trip(noise=0.01, at=0.3)),
    (graze.InputError, "ramp", lambda p: p.trip(ramp=-1e-4)),
    (graze.InputError, "ramp", lambda p: p.trip(ramp=1e-4, wave=0.01, at=0.199)),
    (graze.InputError, "overshoot", lambda p: p.trip(ramp=1e-4, overshoot=1e-3)),
    (graze.InputError, "memory", lambda p: p.trip(memory=3)),
    (graze.InputError, "noise", lambda p: p.trip(noise=-0.01, at=0.199)),
    (graze.InputError, "noise", lambda p: p.trip(noise=0.01, at=0.199, memory=-1)),
    (graze.InputError, "motions", lambda p: p.trip(noise=0.01, at=0.199, motions=-1)),
    (graze.InputError, "wave_period", lambda p: p.trip(wave=0.01, at=0.199, wave_period=0)),
    (graze.InputError, "threads", lambda p: p.trip(noise=0.01, at=0.199, threads=0)),
    (graze.InputError, "vary", lambda p: p.tolerance(vary={"delt": 1})),
    (graze.InputError, "vary", lambda p: p.tolerance(vary={"V": "1%"})),
    (graze.InputError, "vary", lambda p: p.tolerance(vary={"delta": -1})),
    (graze.InputError, "vary", lambda p: p.tolerance(vary={"delta": (1, "flat")})),
    (graze.InputError, "vary", lambda p: p.tolerance(vary={})),
    (graze.InputError, "vary", lambda p: p.tolerance(vary="delta=1%")),
    (graze.InputError, "within", lambda p: p.tolerance(within=(0, 1))),
    (graze.InputError, "within", lambda p: p.tolerance(vary={"delta": 1}, within=3)),
    (graze.InputError, "devices", lambda p: p.tolerance(vary={"delta": 1}, devices=0)),
    (graze.InputError, "devices", lambda p: p.tolerance(vary={"delta": 1}, devices=10**30)),
    (graze.InputError, "seed", lambda p: p.tolerance(vary={"delta": 1}, seed=-1)),
    (graze.InputError, "parameter", lambda p: p.tolerance(parameter="nothing")),
    (graze.InputError, "", lambda p: p.tolerance()(V=1)),
    (graze.InputError, "", lambda p: p.tolerance()(nothing=1)),
    (graze.InputError, "", lambda p: p.tolerance()(delta="x")),
    (KeyError, "", lambda p: p.tolerance()["nothing"]),
    (AttributeError, "", lambda p: p.tolerance().mean),
    (KeyError, "", lambda p: p.grazing()["nothing"]),
    (AttributeError, "", lambda p: p.grazing().nothing),
    (AttributeError, "", lambda p: p.grazing().plot()),
    (graze.InputError, "rungs", lambda p: p.chatter(rungs=0)),
    (graze.InputError, "parameter", lambda p: p.chatter(parameter="nothing")),
    (graze.InputError, "samples", lambda p: p.motion(1)),
    (graze.InputError, "quantities", lambda p: p.motion(quantities=["nothing"])),
    (TypeError, "", lambda p: p.tolerance(progress=3)),
]


@pytest.mark.parametrize("number", range(len(WRONG)))
def test_wrong_uses_are_told(touch, number):
    kind, argument, wrong = WRONG[number]
    with pytest.raises(kind) as told:
        wrong(touch)
    if issubclass(kind, graze.InputError):
        assert argument in told.value.file or argument in str(told.value)
        assert told.value.remedy and "--" not in str(told.value)


def test_points_that_are_neither_touch_nor_fold(oscillator):
    branch = next(oscillator[name] for name in oscillator if oscillator[name].kind == "continue")
    regular = branch[1]
    for analysis in (regular.grazing, regular.trip, regular.tolerance, regular.chatter):
        with pytest.raises(graze.InputError) as told:
            analysis()
        assert told.value.file.startswith(analysis.__name__)


# Against the program


def told_by_program(command, study, point, *options):
    arguments = [PROGRAM, command, study._store.path, *([point] if point else []), *options, "--format", "json"]
    said = subprocess.run(arguments, capture_output=True, text=True, timeout=120)
    assert said.stdout, said.stderr
    return json.loads(said.stdout)


def require_same(table, told):
    """Every number to the last bit."""
    if isinstance(told, dict):
        told = [dict(zip(told["columns"], row)) for row in told["rows"]]
    assert len(table) == len(told)
    for row, expected in enumerate(told):
        for name in table:
            mine, its = table[name][row], expected.get(name)
            if isinstance(mine, str) or isinstance(its, str):
                assert mine == its, name
            else:
                assert mine == its or (its is None and math.isnan(mine)), name


POINTS = [("switch", "no_impact", "GR1"), ("oscillator", "", "GR1"), ("oscillator", "", "PD1"),
          ("actuator", "no_impact", "GR1"), ("testbed", "no_impact_8Hz", "GR1"), ("testbed", "impacting_8Hz", "SN1")]


@needs_program
@pytest.mark.parametrize("fixture, run, label", POINTS)
def test_numbers_equal_those_of_the_program(request, fixture, run, label):
    study = request.getfixturevalue(fixture)
    run = run or next(name for name in study if study[name].kind == "continue" and label in study[name].points["label"])
    point, name = study[run][label], f"{run}:{label}"
    require_same(point.tolerance().derivatives, told_by_program("tolerance", study, name))
    told = told_by_program("orbit", study, name, "--samples", "40")
    require_same(point.motion(40), told)
    certificate = point.certificate()
    for what in ("segments", "minima", "end_values"):
        require_same(getattr(certificate, what), told[what])
    assert (certificate.signature, certificate.symmetry) == (told["signature"], told["symmetry"])
    require_same(graze.points(study, all=True), told_by_program("points", study, "", "--all"))
    if label == "GR1":
        found, told = point.grazing(verify=True), told_by_program("grazing", study, name, "--verify")
        require_same(found.facts, told)
        require_same(found.trial_motions, told["trial_motions"])
        assert dict(found) == told["values"] and found.reason == told["reason"]
        if found.verdict != "lost":
            return
    if label in ("GR1", "SN1"):
        require_same(point.trip().table, told_by_program("trip", study, name))


@needs_program
@pytest.mark.parametrize("options, asked", [
    (("--overshoot", "1e-2:1e-20", "--until", "end"), dict(overshoot="1e-2:1e-20", until="end")),
    (("--overshoot", "1e-3,1e-6", "--until", "q=0.9", "--disturbance", "q=1e-4"),
     dict(overshoot=[1e-3, 1e-6], until=("q", 0.9), disturbance={"q": 1e-4})),
    (("--overshoot", "1e-4", "--greatest-speed", "0.01"), dict(overshoot=1e-4, greatest_speed=0.01)),
    (("--ramp", "1e-4:1e-6"), dict(ramp="1e-4:1e-6")),
    (("--ramp", "1e-5", "--at", "0.2"), dict(ramp=1e-5, at=0.2)),
    (("--wave", "0.001,0.003", "--at", "0.199", "--wave-period", "50", "--cycles", "80"),
     dict(wave=[0.001, 0.003], at=0.199, wave_period=50, cycles=80)),
    (("--noise", "0.003,0.004", "--at", "0.199", "--motions", "30", "--seed", "7", "--memory", "2", "--cycles", "40"),
     dict(noise=[0.003, 0.004], at=0.199, motions=30, seed=7, memory=2, cycles=40)),
])
def test_trips_equal_those_of_the_program(switch, touch, options, asked):
    told = told_by_program("trip", switch, "no_impact:GR1", *options)
    trips = touch.trip(**asked)
    require_same(trips.table, told)
    assert (trips.value, trips.cycle, trips.speed, trips.end) == (told["touch"], told["cycle"], told["speed"], told["end"])


@needs_program
def test_yields_and_ladders_equal_those_of_the_program(switch, touch, actuator):
    told = told_by_program("tolerance", switch, "no_impact:GR1", "--vary", "delta=0.3,zeta=10%:uniform", "--within",
                           "0.19:0.21", "--devices", "150", "--seed", "3")
    found = touch.tolerance(vary={"delta": 0.3, "zeta": ("10%", "uniform")}, within=(0.19, 0.21), devices=150, seed=3)
    require_same(found.derivatives, told)
    for name, low, high in zip(*(found.statistics[column] for column in ("quantity", "low", "high"))):
        assert found._statistics[name][0] == told["statistics"][name]
        for value, limit in ((low, f"{name}_low"), (high, f"{name}_high")):
            its = told["statistics"].get(limit)
            assert value == its or (its is None and math.isnan(value))
    assert found.failed > 0 and found.problems == {one["problem"]: one["devices"] for one in told["problems"]}
    told = told_by_program("ladder", actuator, "no_impact:GR1", "--rungs", "4")
    ladder = actuator["no_impact"]["GR1"].chatter(rungs=4)
    require_same(ladder.table, told)
    for name in ("limit", "limit_error", "extrapolated", "extrapolated_error", "restitution", "ratio", "ends"):
        assert getattr(ladder, name) == told[name]
