"""Simulated benches and acquisition: samples against simulation, records through real connections, failures."""

import math
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import graze

ROOT = pathlib.Path(__file__).parents[2]
SWEEP = re.search(r"```toml file=sweep.toml\n(.*?)```", (ROOT / "docs/experiment.md").read_text(), re.S).group(1)
SHORT = {"sweep": {"amplitude": [4.7, 4.8, 4.9]}, "settle": {"time": 0.2}, "record": {"time": 0.3}}
NOISE = {"amplitude": "V0=2", "noise": {"v": 0.002}, "range": {"v": 1}}


def a_testbed(**more):
    return graze.Bench("electromagnetic-testbed", **{**NOISE, **more})


def test_samples_are_those_of_a_simulation():
    bench = graze.Bench("electromagnetic-testbed", amplitude="V0=2")
    assert bench.channels[0] == "V" and {"q", "v", "I"} <= set(bench.channels)
    bench.drive(frequency=6.1, amplitude=4.8)
    record = bench.record(0.5, rate=2000)
    assert record.units == bench.units and record.time_unit == "s" and len(record.t) == 1000
    model = graze.load("electromagnetic-testbed")
    model.parameters.V0, model.parameters.f = 4.8, 6.1
    motion = graze.simulate(model, at=record.t, tolerance=1e-11)
    for name in ("q", "v", "I"):
        assert np.allclose(record[name], motion[name], rtol=0, atol=1e-7 * np.abs(motion[name]).max())
    assert bench.time == pytest.approx(0.5)
    assert record.period("V").period == pytest.approx(1 / 6.1, rel=1e-6)
    assert record.harmonic("V", 2 * math.pi * 6.1).amplitude == pytest.approx(4.8, rel=1e-9)


def test_function_and_class_are_the_same():
    one, other = graze.bench("electromagnetic-testbed", **NOISE), a_testbed()
    assert np.array_equal(one.record(0.1)["v"], other.record(0.1)["v"])
    assert "electromagnetic-testbed" in repr(one)
    with pytest.raises(TypeError, match="colour"):
        graze.bench("electromagnetic-testbed", colour="red")


def test_sensors():
    quiet, noisy = graze.Bench("electromagnetic-testbed"), graze.Bench("electromagnetic-testbed", noise={"v": 0.01},
                                                                       bias={"q": 1e-3}, range={"v": 0.5}, bits=8, seed=7)
    one, other = quiet.record(2.0), noisy.record(2.0)
    assert np.allclose(other["q"] - one["q"], 1e-3, atol=1e-15)
    steps = other["v"] / (1 / 256)
    assert np.allclose(steps, np.round(steps), atol=1e-9)
    assert np.std(other["v"] - one["v"]) == pytest.approx(math.hypot(0.01, 1 / 256 / math.sqrt(12)), rel=0.1)
    again = graze.Bench("electromagnetic-testbed", noise={"v": 0.01}, bias={"q": 1e-3}, range={"v": 0.5}, bits=8, seed=7)
    assert np.array_equal(again.record(2.0)["v"], other["v"])
    named = graze.Bench("electromagnetic-testbed", channels={"x": ("1000*q", "mm"), "I": "I"})
    assert named.channels == ("x", "I") and named.units["x"] == "mm"
    assert np.allclose(named.record(0.1)["x"], 1000 * graze.Bench("electromagnetic-testbed").record(0.1)["q"])


def test_time_and_states():
    bench = a_testbed()
    bench.drive(frequency=6.1, amplitude=4.8)
    bench.wait(1.5)
    assert bench.time == pytest.approx(1.5)
    bench.mark(1)
    first = bench.record(0.2)
    bench.return_to(1)
    assert np.array_equal(bench.record(0.2)["v"], first["v"])
    with pytest.raises(graze.InputError, match="no state"):
        bench.return_to(2)


def test_generator_understands_its_commands():
    bench = a_testbed()
    assert "33120A" in bench.command("*IDN?")
    bench.command("SYST:REM")
    bench.command("VOLT:UNIT VPP;:VOLT 3;:FREQ 7")
    assert float(bench.command("VOLT?")) == 3
    record = bench.record(1.0)
    assert record.period("V").period == pytest.approx(1 / 7, rel=1e-5)
    assert record.harmonic("V", 14 * math.pi).amplitude == pytest.approx(3, rel=1e-4)
    assert bench.command("NONSENSE") == "" and bench.command("SYST:ERR?").startswith("-113")


def test_experiment_of_the_documentation():
    experiment = graze.Experiment(text=SWEEP)
    levels = experiment.levels
    assert len(levels) == 18 and experiment.samples == 5000 and experiment.rate == 1000
    assert np.allclose(levels["amplitude"][:9], 4.7 + 0.05 * np.arange(9))
    assert levels["direction"][1] == 1 and levels["direction"][-1] == -1
    assert levels["file"][0].startswith("0001_f6100mHz_a4700mV")
    changed = graze.Experiment(text=SWEEP, **SHORT)
    assert changed.samples == 300 and changed.levels["amplitude"].tolist() == [4.7, 4.8, 4.9]


def test_acquisition_from_a_bench(tmp_path):
    told = []
    found = graze.acquire(text=SWEEP, output=tmp_path / "records", bench=a_testbed(), progress=told.append, **SHORT)
    assert found.complete and found.safe and found.recorded == 3 and found.before == 0
    assert [record.name for record in found.records] == [str(tmp_path / "records" / name) for name in found.entries["file"]]
    assert np.allclose(found.entries["told"], [4.7, 4.8, 4.9])
    for record, level in zip(found.records, (4.7, 4.8, 4.9)):
        assert len(record.t) == 300
        assert record.harmonic("V", 2 * math.pi * 6.1).amplitude == pytest.approx(level, rel=1e-3)
    # Nothing is recorded twice; the same commands give the same samples.
    bench = a_testbed()
    again = graze.acquire(text=SWEEP, output=tmp_path / "records", bench=bench, **SHORT)
    assert again.recorded == 0 and again.before == 3 and bench.time < 0.01
    other = graze.acquire(text=SWEEP, output=tmp_path / "others", bench=a_testbed(), **SHORT)
    for one, another in zip(found.records, other.records):
        assert np.array_equal(one["v"], another["v"])
    assert float(bench.command("VOLT?")) == pytest.approx(0.1)
    with pytest.raises(graze.InputError):
        graze.acquire(text=SWEEP, output=tmp_path / "records", bench=a_testbed(),
                      **{**SHORT, "record": {"time": 0.2}})


def test_interruption_and_continuation(tmp_path):
    def stop(state):
        return not (state["recorded"] == 1 and state["stage"] == "settling")

    keys, bench = {**SHORT, "settle": {"time": 100.0}}, a_testbed()
    with pytest.raises(graze.Interrupted) as raised:
        graze.acquire(text=SWEEP, output=tmp_path / "records", bench=bench, progress=stop, **keys)
    found = raised.value.run
    assert not found.complete and found.safe and found.ending == "interrupted"
    assert len(found.entries) == len(found.records) == 1
    # The bench returns to its state after the last record: the records are those of an acquisition in one go.
    more = graze.acquire(text=SWEEP, output=tmp_path / "records", bench=bench, **keys)
    assert more.complete and more.before == 1 and more.recorded == 2
    whole = graze.acquire(text=SWEEP, output=tmp_path / "whole", bench=a_testbed(), **keys)
    for one, another in zip(more.records, whole.records):
        assert np.array_equal(one["v"], another["v"])


def test_acquisition_through_connections(tmp_path):
    direct = graze.acquire(text=SWEEP, output=tmp_path / "direct", bench=a_testbed(), **SHORT)
    bench = a_testbed()
    with bench.serve(on_demand=True) as service:
        assert os.path.exists(service.generator) and service.samples.startswith("tcp:127.0.0.1:")
        with pytest.raises(graze.OrderError, match="in use"):
            bench.record(1)
        found = graze.acquire(text=SWEEP, output=tmp_path / "records", port=service.generator, device=service.samples,
                              **SHORT)
    assert found.complete and found.safe
    for one, another in zip(found.records, direct.records):
        assert np.array_equal(one["v"], another["v"])
    assert not os.path.exists(service.generator)
    assert bench.record(0.1).channels == bench.channels


def test_instruments_that_fail(tmp_path):
    bench = a_testbed(clip=4.75)
    with pytest.raises(graze.InstrumentError, match="clipped") as raised:
        graze.acquire(text=SWEEP, output=tmp_path / "clipped", bench=bench, **SHORT)
    assert raised.value.run.recorded == 1 and raised.value.run.safe
    with pytest.raises(graze.InstrumentError) as raised:
        graze.acquire(text=SWEEP, output=tmp_path / "absent", port=str(tmp_path / "nothing"), device="tcp:127.0.0.1:1",
                      **SHORT)
    assert raised.value.run.records is None
    with pytest.raises(graze.InstrumentError, match="foreign"):
        graze.acquire(text=SWEEP, output=tmp_path / "foreign", bench=a_testbed(), generator={"identity": "34401A"}, **SHORT)


def test_a_killed_process_leaves_the_generator_safe(tmp_path):
    bench = a_testbed()
    code = """
import sys
sys.path[:] = sys.argv[5:]
import graze
def tell(state):
    if state["stage"] == "settling":
        print("settling", flush=True)
graze.acquire(text=sys.argv[1], port=sys.argv[2], device=sys.argv[3], output=sys.argv[4], settle={"time": 600},
              progress=tell)
"""
    with bench.serve() as service:
        process = subprocess.Popen([sys.executable, "-c", code, SWEEP, service.generator, service.samples,
                                    tmp_path / "records", *sys.path], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        assert process.stdout.readline() == b"settling\n"  # the first level is set
        process.kill()
        told = process.stderr.read().decode()  # to the end of the second process
        process.wait()
    assert "was killed; the generator is off, or at its safe amplitude" in told
    assert float(bench.command("VOLT?")) == pytest.approx(0.1)


def test_motions_that_end():
    model = graze.load("mems-switch")
    bench = graze.Bench(model, amplitude="V", frequency="omega=2*pi")
    bench.drive(frequency=1 / (2 * math.pi), amplitude=10)
    with pytest.raises(graze.InstrumentError, match="ended"):
        bench.record(100, rate=100)
    assert bench.ended


@pytest.mark.parametrize("wrong, words", [
    (lambda: graze.Bench("absent-model"), "absent-model"),
    (lambda: graze.Bench(3), ""),
    (lambda: graze.Bench("electromagnetic-testbed", amplitude="W"), "W"),
    (lambda: graze.Bench("electromagnetic-testbed", frequency=3), "frequency"),
    (lambda: graze.Bench("electromagnetic-testbed", channels="x=y"), "y"),
    (lambda: graze.Bench("electromagnetic-testbed", channels=3), "channels"),
    (lambda: graze.Bench("electromagnetic-testbed", noise={"w": 1}), "w"),
    (lambda: graze.Bench("electromagnetic-testbed", noise=3), "noise"),
    (lambda: graze.Bench("electromagnetic-testbed", noise={"v": -1}), ""),
    (lambda: graze.Bench("electromagnetic-testbed", bits=0), "bits"),
    (lambda: graze.Bench("electromagnetic-testbed", anti_alias=-1), "anti_alias"),
    (lambda: graze.Bench("electromagnetic-testbed", left_as="NONSENSE"), ""),
    (lambda: a_testbed().drive(frequency=6, amplitude=5, shape="round"), "round"),
    (lambda: a_testbed().drive(frequency=-6, amplitude=5), "frequency"),
    (lambda: a_testbed().drive(frequency=6, amplitude=5, offset=1), "offset"),
    (lambda: a_testbed().record(0), "time"),
    (lambda: a_testbed().record(1, rate=1e9), "samples per second"),
    (lambda: a_testbed().wait(-1), "seconds"),
    (lambda: a_testbed().command(3), "line"),
    (lambda: a_testbed().serve(tcp=-1), "tcp"),
    (lambda: a_testbed().serve(drop=2), "lost"),
    (lambda: a_testbed().serve(port="/absent/folder/generator"), "generator"),
    (lambda: graze.Experiment("absent.toml"), "cannot be read"),
    (lambda: graze.Experiment(3), "experiment"),
    (lambda: graze.Experiment(text=SWEEP, sweep={"amplitude": {"to": 6}}), "limits"),
    (lambda: graze.Experiment(text=SWEEP, colour="red"), "colour"),
    (lambda: graze.Experiment(text="name ="), "TOML"),
    (lambda: graze.Experiment(), ""),
    (lambda: graze.acquire(text=SWEEP, generator={"port": None}), "generator"),
    (lambda: graze.acquire(text=SWEEP, samples={"device": None}), "samples"),
    (lambda: graze.acquire(text=SWEEP, port="tcp:x"), "port"),
    (lambda: graze.acquire(text=SWEEP, bench=3), "bench"),
    (lambda: graze.acquire(text=SWEEP, bench=a_testbed(), port="x"), "addresses"),
    (lambda: graze.acquire(text=SWEEP, bench=a_testbed(), output=3), "output"),
    (lambda: graze.acquire(graze.Experiment(text=SWEEP), name="x"), "keys"),
])
def test_wrong_uses(wrong, words):
    with pytest.raises(graze.InputError, match=words):
        wrong()


def test_mistakes_are_told_with_the_keyword():
    with pytest.raises(graze.InputError) as raised:
        graze.Experiment(text=SWEEP, limits={"amplitude": -1})
    assert raised.value.place == "Experiment(), limits"
