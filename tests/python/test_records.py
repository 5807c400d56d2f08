"""Measured records: closed forms, what is read and written, estimates with known truth, and wrong uses."""

import copy
import math
import os
import pickle
import signal
import threading
import warnings

import numpy as np
import pytest

import graze

T = np.arange(4000) * 0.001


def sines(times=T):
    """A record of two periods per 0.32 time units, with closed forms for everything."""
    return graze.MeasuredRecord(times, {"V": 3 * np.sin(2 * np.pi * 6.25 * times + 0.3),
                                        "q": 0.5 + 2 * np.cos(2 * np.pi * 6.25 * times)},
                                units={"V": "V", "q": "mm"}, time_unit="s", name="sines")


def bouncing(e=0.8, step=1e-4, noise=0.0):
    """A ball that leaves a floor with speed 1 under gravity 10 and bounces: position and velocity, and impact times."""
    generator = np.random.default_rng(1)
    times, speed, impacts = [0.0], 1.0, []
    while times[-1] < 0.7:
        times.append(times[-1] + 2 * speed / 10)
        impacts.append((times[-1], -speed, e * speed))
        speed *= e
    t = np.arange(0, 0.6, step)
    v, q = np.empty_like(t), np.empty_like(t)
    speed = 1.0
    for begin, end in zip(times, times[1:]):
        inside = (t >= begin) & (t < end)
        since = t[inside] - begin
        v[inside], q[inside] = speed - 10 * since, speed * since - 5 * since**2
        speed *= e
    record = graze.MeasuredRecord(t, {"q": q, "v": v + noise * generator.standard_normal(len(t))})
    return record, [one for one in impacts if one[0] < t[-1]]


def test_samples_are_what_was_given():
    record = sines()
    assert record.channels == ("V", "q") and record.units == {"V": "V", "q": "mm"} and record.time_unit == "s"
    assert np.array_equal(record.t, T)
    assert np.array_equal(record["V"], 3 * np.sin(2 * np.pi * 6.25 * T + 0.3)) and record.V is record["V"]
    assert record.samples is record.samples
    assert record.samples.units == {"t": "s", "V": "V", "q": "mm"}


def test_arrays_outlive_their_record():
    values = sines()["V"]
    for _ in range(20):
        sines().samples
    assert np.array_equal(values, 3 * np.sin(2 * np.pi * 6.25 * T + 0.3))


def test_given_arrays_are_copied():
    values = np.sin(T)
    record = graze.MeasuredRecord(T, {"x": values})
    values[:] = 0
    assert np.array_equal(record["x"], np.sin(T))


def test_summary():
    table = sines().summary()
    assert table["channel"] == ["V", "q"]
    assert table["samples"].tolist() == [4000, 4000]
    values = sines()["q"]
    assert table["mean"][1] == pytest.approx(values.mean(), abs=1e-12)
    assert table["least"][1] == values.min() and table["greatest"][1] == values.max()
    assert table["shortest_step"][0] == pytest.approx(0.001, rel=1e-9)


def test_period_and_harmonic():
    fit = sines().period("V")
    assert fit.period == pytest.approx(0.16, rel=1e-9)
    assert fit.begin == pytest.approx(0.16 * (1 - 0.3 / (2 * np.pi)), abs=1e-7)
    assert fit.periods == 24 and fit.amplitude == pytest.approx(3, rel=1e-6)
    harmonic = sines().harmonic("V", 2 * np.pi * 6.25)
    assert harmonic.amplitude == pytest.approx(3, rel=1e-12)
    assert harmonic.phase == pytest.approx(0.3, rel=1e-12)
    assert harmonic.offset == pytest.approx(0, abs=1e-12) and harmonic.samples == 4000
    assert math.hypot(harmonic.sine, harmonic.cosine) == pytest.approx(harmonic.amplitude, rel=1e-14)


def test_periods_sections_and_extremes():
    record = sines()
    periods = record.periods("V")
    assert len(periods) == 24 and np.allclose(periods["duration"], 0.16, rtol=1e-6)
    begin = 0.16 * (1 - 0.3 / (2 * np.pi))
    section = record.sections("V", phases=[0, 0.25])
    assert len(section) == 48
    assert np.allclose(section["V"][section["phase"] == 0], 0, atol=1e-4)
    assert np.allclose(section["V"][section["phase"] == 0.25], 3, rtol=1e-6)
    expected = 0.5 + 2 * np.cos(2 * np.pi * 6.25 * begin)
    assert np.allclose(section["q"][section["phase"] == 0], expected, atol=1e-4)
    extremes = record.extremes("V", channels="q")
    assert np.allclose(extremes["q_greatest"], 2.5, rtol=1e-6) and np.allclose(extremes["q_peak_to_peak"], 4, rtol=1e-6)
    images = record.sections("V", negate="V", channels="V")
    assert len(images) == 48 and set(images["image"]) == {"no", "yes"}
    assert np.allclose(images["V"], 0, atol=1e-4)


def test_spectrum():
    table = sines().spectrum("V")
    assert table["frequency"][0] == pytest.approx(0.25) and len(table) == 2000
    largest = int(np.argmax(table["amplitude"]))
    assert table["frequency"][largest] == pytest.approx(6.25)
    assert table["amplitude"][largest] == pytest.approx(3, rel=1e-12)
    values = sines()["V"]
    expected = 2 * np.abs(np.fft.rfft(values - values.mean()))[1:] / len(values)
    assert np.allclose(table["amplitude"][:-1], expected[:-1], atol=1e-12)
    parts = sines().spectrum("V", part=1000)
    assert len(parts) == 500


def test_impacts_and_restitution():
    record, truth = bouncing()
    found = record.impacts("v", displacement="q")
    assert len(truth) >= 3 and len(found) == len(truth)
    assert np.allclose(found["time"], [one[0] for one in truth], atol=1e-6)
    assert np.allclose(found["before"], [one[1] for one in truth], rtol=1e-3)
    assert np.allclose(found["after"], [one[2] for one in truth], rtol=1e-3)
    noisy, _ = bouncing(noise=0.01)
    estimate = graze.restitution(noisy, displacement="q")["restitution"]
    assert estimate.low < 0.8 < estimate.high and estimate.error < 0.01


def test_derivative_and_filter():
    values = 1 + T - T**2 + 0.5 * T**3 - 0.1 * T**4
    record = graze.MeasuredRecord(T, {"x": values}).processed(derivative="x", half_width=10)
    assert record.channels == ("x", "x_rate", "x_rate_error")
    assert len(record.t) == len(T) - 20
    assert np.allclose(record["x_rate"], 1 - 2 * record.t + 1.5 * record.t**2 - 0.4 * record.t**3, atol=1e-9)
    slow, fast = np.sin(2 * np.pi * 5 * T), np.sin(2 * np.pi * 200 * T)
    filtered = graze.MeasuredRecord(T, {"x": slow + fast}).processed(pass_=20, stop=60)
    assert np.allclose(filtered["x"], np.sin(2 * np.pi * 5 * filtered.t), atol=3e-4)
    thinned = graze.MeasuredRecord(T, {"x": slow}).processed(every=4)
    assert np.allclose(np.diff(thinned.t), 0.004) and len(thinned.t) < 1000


def test_scale_and_part():
    record = sines().processed(scale={"q": (1000, 1, "um"), "V": 2}, from_=1, to=2)
    assert record.units == {"V": "V", "q": "um"}
    assert record.t[0] == 1.0 and record.t[-1] == 2.0
    inside = (T >= 1) & (T <= 2)
    assert np.array_equal(record["q"], 1000 * sines()["q"][inside] + 1)
    assert np.array_equal(record["V"], 2 * sines()["V"][inside])
    twice = record.processed(from_=1.5)
    assert twice.t[0] == 1.5 and record.t[0] == 1.0


@pytest.mark.parametrize("name", ["run.csv", "run.h5"])
def test_files_are_read_back_exactly(tmp_path, name):
    path = tmp_path / name
    sines().write(path)
    read = graze.read_record(path)
    assert read.units == {"V": "V", "q": "mm"} and read.time_unit == "s"
    for channel in ("V", "q"):
        assert np.array_equal(read[channel], sines()[channel])
    assert np.array_equal(read.t, T)
    sines().write(path, channels="q")
    assert graze.read_record(path).channels == ("q",)
    assert os.listdir(tmp_path) == [name]


def test_an_input_is_not_replaced(tmp_path):
    path = tmp_path / "run.csv"
    sines().write(path)
    before = path.read_bytes()
    link = tmp_path / "link.csv"
    link.symlink_to(path)
    for target in (path, link):
        with pytest.raises(graze.InputError, match="record too"):
            graze.read_record(path, every=2).write(target)
    assert path.read_bytes() == before
    with pytest.raises(graze.FileError, match="folder"):
        sines().write(tmp_path)
    with pytest.raises(graze.FileError):
        sines().write(tmp_path / "absent" / "run.csv")


def test_files_of_instruments(tmp_path):
    path = tmp_path / "logger.txt"
    path.write_text("Logger 7\nZeit;Kraft\n(ms);(N)\nstarted at noon\n0,5;1,25\n1,0;1,50\n")
    record = graze.read_record(path, names_line=2, units_line=3, skip=4)
    assert record.units == {"Kraft": "N"} and record.time_unit == "ms"
    assert record.t.tolist() == [0.5, 1.0] and record["Kraft"].tolist() == [1.25, 1.5]
    plain = tmp_path / "plain.txt"
    plain.write_text("0 1 2\n1 3 4\n")
    assert graze.read_record(plain, columns="t [s], a [V], b").channels == ("a", "b")


def test_missing_values_are_told(tmp_path):
    path = tmp_path / "gaps.csv"
    path.write_text("t,x\n0,1\n1,nan\n2,3\n")
    with pytest.warns(UserWarning, match="1 of 3 rows"):
        record = graze.read_record(path)
        assert record["x"].tolist() == [1, 3]
    assert len(record.remarks) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        record.summary()  # told once


def test_several_records(tmp_path):
    paths = [tmp_path / name for name in ("a.csv", "b.csv")]
    for path, factor in zip(paths, (1, 2)):
        sines().processed(scale={"V": factor}).write(path)
    both = graze.read_record(*paths)
    assert len(both) == 2 and both[1].name == str(paths[1]) and len(both[:1]) == 1
    table = both.periods("V")
    assert table["file"] == [str(paths[0])] * 24 + [str(paths[1])] * 24
    assert np.allclose(table["V_amplitude"][[0, -1]], [3, 6], rtol=1e-6)
    assert both.processed(every=2)[0].units == both[0].units
    assert graze.MeasuredRecords([sines(), sines()]).summary()["samples"].tolist() == [4000] * 4


def test_decrement_of_a_damped_sine():
    generator = np.random.default_rng(2)
    t, w0, zeta = np.arange(0, 3, 1e-3), 2 * np.pi * 9, 0.02
    wave = np.exp(-zeta * w0 * t) * np.sin(w0 * math.sqrt(1 - zeta**2) * t + 1)
    releases = [graze.MeasuredRecord(t, {"v": wave + 0.003 * generator.standard_normal(len(t))}, time_unit="s")
                for _ in range(3)]
    found = graze.decrement(*releases, peaks=15)
    assert found.warnings == []
    frequency, damping = found["natural_frequency"], found["damping_ratio"]
    assert frequency.low < w0 / (2 * np.pi if frequency.unit == "Hz" else 1) < frequency.high
    assert damping.low < zeta < damping.high and damping.error < 1e-3
    assert damping.high - damping.value == pytest.approx(damping.value - damping.low)
    assert math.sqrt(found.covariance[1, 1]) == pytest.approx(damping.error, rel=0.5)
    assert found.table["name"][:2] == list(found)[:2]
    assert len(found.plot()) == 2
    copied = pickle.loads(pickle.dumps(found))
    assert list(copied) == list(found) and copied.table == found.table
    with pytest.raises(graze.OrderError):
        copied.plot()


def test_impedance_of_a_coil():
    w, resistance, inductance = 2 * np.pi * 50, 2.0, 0.01
    generator = np.random.default_rng(3)
    t = np.arange(0, 0.5, 1e-4)
    size, lag = math.hypot(resistance, w * inductance), math.atan2(w * inductance, resistance)
    voltage = 5 * np.sin(w * t) + 1e-3 * generator.standard_normal(len(t))
    current = 5 / size * np.sin(w * t - lag) + 1e-3 * generator.standard_normal(len(t))
    record = graze.MeasuredRecord(t, {"V": voltage, "I": current}, units={"V": "V", "I": "A"}, time_unit="s")
    found = graze.impedance(record)
    assert found["resistance"].low < resistance < found["resistance"].high
    assert found["inductance"].low < inductance < found["inductance"].high
    assert found["resistance"].error < 1e-3
    more = graze.impedance(record, beta1=(1e-5, 1e-7), beta2=1e-3, gap=4e-3)
    leakage = more["leakage_inductance"]
    assert leakage.value == pytest.approx(more["inductance"].value - 1e-5 / 5e-3, rel=1e-12)


def test_coupling_of_a_magnet():
    beta1, beta2, gap, stiffness = 2e-5, 3e-4, 4e-3, 6000.0
    q = np.linspace(1e-4, 1.2e-3, 30)
    current = np.sqrt(2 * stiffness * q / beta1) * (beta2 + gap - q)
    generator = np.random.default_rng(4)
    record = graze.MeasuredRecord(np.arange(30.0), {"q": q + 1e-6 * generator.standard_normal(30),
                                                    "I": current + 1e-3 * generator.standard_normal(30)})
    found = graze.coupling(record, gap=gap, stiffness=(stiffness, 1.0), noise=(1e-6, 1e-3))
    assert found["beta1"].low < beta1 < found["beta1"].high
    assert found["beta2"].low < beta2 < found["beta2"].high


def test_doubtful_estimates_are_told():
    t = np.arange(0, 3, 1e-3)
    wave = np.clip(np.exp(-t) * np.sin(60 * t), -0.5, 0.5)
    found = graze.decrement(graze.MeasuredRecord(t, {"v": wave}))
    assert found.warnings and "warnings" in repr(found) and "clipped" in found.warnings[0] and "clipped" in found._repr_html_()


def test_pictures():
    record = sines()
    assert len(record.plot()) == 2
    axes = record.plot("spectrum", channel="V")
    assert len(axes.lines) + len(axes.collections) >= 1
    assert record.plot("extremes", reference="V", channels="q") is not None
    assert "png" in record._repr_html_() and "V [V]" in repr(record)


def test_interruption():
    t = np.arange(3_000_000) * 1e-3
    record = graze.MeasuredRecord(t, {"v": np.sin(t)})
    timer = threading.Timer(0.05, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(graze.Interrupted):
        for _ in range(100):
            record.impacts("v", window=100)
    timer.join()
    assert record.summary()["samples"][0] == 3_000_000


@pytest.mark.parametrize("wrong, words", [
    (lambda: graze.read_record("absent.csv"), "absent"),
    (lambda: graze.read_record(3), "3 is no path"),
    (lambda: graze.read_record(""), "no name"),
    (lambda: graze.read_record(os.curdir), ""),
    (lambda: graze.read_record("absent.csv", skip=-1), "skip"),
    (lambda: graze.read_record("absent.csv", every=0), "every"),
    (lambda: graze.read_record("absent.csv", stop=3), "pass_"),
    (lambda: graze.read_record("absent.csv", half_width=9), "derivative"),
    (lambda: sines().processed(scale={"x": 2}), "channel"),
    (lambda: sines().processed(scale=3), "scale"),
    (lambda: sines().processed(scale={"q": (1, 2, 3, 4)}), "items"),
    (lambda: sines().processed(derivative="x"), "channel"),
    (lambda: sines().processed(pass_=float("nan")), "pass_"),
    (lambda: sines().processed(from_="early"), "from_"),
    (lambda: sines().processed(from_=100).samples, "no rows"),
    (lambda: sines().periods("X"), "X"),
    (lambda: sines().periods("V", level=100), "period"),
    (lambda: sines().periods("V", hysteresis=-1), "hysteresis"),
    (lambda: sines().sections("V", phases=1), "phase"),
    (lambda: sines().sections("V", negate="Z"), "Z"),
    (lambda: sines().spectrum("V", part=3), "part"),
    (lambda: sines().spectrum("V", part=5000), "part"),
    (lambda: sines().impacts("V", window=2), "window"),
    (lambda: sines().table("nothing"), "nothing"),
    (lambda: sines().table(3), "what"),
    (lambda: sines().harmonic("V", -1), "frequency"),
    (lambda: sines().write(3), "file"),
    (lambda: graze.MeasuredRecord([0, 1], {"x": [1, 2, 3]}), "samples"),
    (lambda: graze.MeasuredRecord([1, 0], {"x": [1, 2]}), ""),
    (lambda: graze.MeasuredRecord([0, 1], {"x": [1, float("nan")]}), ""),
    (lambda: graze.MeasuredRecord([[0, 1]], {"x": [1, 2]}), "axes"),
    (lambda: graze.MeasuredRecord([0, 1], {"x": ["a", "b"]}), "numbers"),
    (lambda: graze.MeasuredRecord([0, 1], [1, 2]), "dict"),
    (lambda: graze.MeasuredRecord([0, 1], {"x": [1, 2]}, units={"y": "V"}), "y"),
    (lambda: graze.MeasuredRecords([]), "no records"),
    (lambda: graze.decrement(), "no records"),
    (lambda: graze.decrement(sines(), channel="x"), "x"),
    (lambda: graze.decrement(sines(), peaks=1), "peaks"),
    (lambda: graze.restitution(sines(), channel="V"), ""),
    (lambda: graze.coupling(sines(), gap=-1, stiffness=1), "gap"),
    (lambda: graze.coupling(sines(), gap=1, stiffness=1, noise=3), "noise"),
    (lambda: graze.impedance(sines(), current="q", beta1=(1, 2, 3)), "beta1"),
])
def test_wrong_uses(wrong, words):
    with pytest.raises(graze.InputError, match=words):
        wrong()


def test_wrong_arguments():
    with pytest.raises(TypeError, match="columnz"):
        graze.read_record("absent.csv", columnz="t")
    with pytest.raises(TypeError, match="refrence"):
        sines().table("periods", refrence="V")
    with pytest.raises(KeyError, match="no channel"):
        sines()["x"]
    with pytest.raises(AttributeError):
        sines().nothing


def test_mistakes_in_files_have_their_place(tmp_path):
    path = tmp_path / "wrong.csv"
    path.write_text("t [s], V [V]\n0, 1\n0.1, one\n")
    with pytest.raises(graze.InputError) as raised:
        graze.read_record(path).samples
    assert (raised.value.file, raised.value.line) == (str(path), 3)


def test_arrays_become_a_fitted_model():
    """From one's own arrays to a model with intervals that cover the truth, through impacts."""
    truth = {"zeta": 0.05, "e": 0.75}
    model = graze.Model.shipped("impact-oscillator", omega=2.8, **truth)
    motion = graze.simulate(model, time=20, every=0.02)
    noise = 1e-3 * np.random.default_rng(5).standard_normal(len(motion.t))
    measured = graze.MeasuredRecord(motion.t, {"x": motion["x"] + noise})
    guess = graze.Model.shipped("impact-oscillator", omega=2.8, zeta=0.04, e=0.7)
    for records in (measured, graze.MeasuredRecords([measured, measured.processed(from_=5)])):
        fit = records.fit(guess, unknowns=["zeta", "e"], readings=["x"])
        for name, value in truth.items():
            assert abs(fit[name] - value) < 4 * fit.errors[name] < 0.02
    with pytest.raises(graze.StudyError, match="unknowns"):
        measured.fit(guess, unknowns=["nothing"], readings=["x"])
    with pytest.raises(graze.InputError, match="identify"):
        measured.fit(guess, what="decrement")


def test_records_can_be_copied_and_pickled(tmp_path):
    path = tmp_path / "gaps.csv"
    path.write_text("t [s], V [V]\n0, 1\n0.1, nan\n0.2, 3\n0.3")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        record = graze.read_record(path)
        again = pickle.loads(pickle.dumps(record))
    path.unlink()
    assert again.samples == record.samples and repr(again) == repr(record)
    assert again.remarks == record.remarks != []
    assert again.processed(from_=0.1).t.tolist() == [0.2]
    several = graze.MeasuredRecords([sines(), sines()])
    for made in (pickle.loads(pickle.dumps(several)), copy.deepcopy(several), copy.copy(several)):
        assert [one.samples for one in made] == [one.samples for one in several]
        assert made.periods("V") == several.periods("V")
