"""What the compiled part does with copies, odd texts and numbers, and interruptions."""

import signal
import subprocess
import sys
import time

import numpy
import pytest

import graze
from graze import _graze

CLASSES = {name: one for name, one in vars(_graze).items() if isinstance(one, type)}
ENDLESS = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c WHERE x < 300000000) SELECT count(*) FROM c"

# What holds compiled objects, and what is tried with each of these. A process that ends by itself says nothing.
COPIES = """
import copy, pickle
import graze
from graze import _graze

def compiled(one, seen):
    if id(one) in seen or len(seen) > 20000:
        return
    seen[id(one)] = one
    if vars(_graze).get(type(one).__name__) is type(one):
        yield one
    elif type(one).__module__.startswith("graze"):
        slots = [name for kind in type(one).__mro__ for name in getattr(kind, "__slots__", ())]
        held = [getattr(one, name, None) for name in slots if isinstance(name, str)] + list(getattr(one, "__dict__", {}).values())
        for part in held:
            yield from compiled(part, seen)

model = graze.Model.shipped("impact-oscillator", omega=2.75)
branch = graze.orbit(model).follow(omega=(2.74, 2.76))
owners = [graze.MeasuredRecord([0, 1, 2], {"x": [1, 2, 3]}), model, branch, graze.Simulation(model),
          graze.simulate(model, time=1), _graze.PartExchange()]
objects = {}
for owner in owners:
    for one in compiled(owner, {}):
        objects.setdefault(type(one).__name__, one)
for name, one in objects.items():
    ways = [lambda protocol=protocol: pickle.dumps(one, protocol) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]
    for way in [*ways, lambda: copy.copy(one), lambda: copy.deepcopy(one)]:
        try:
            way()
        except TypeError as error:
            assert "can neither be copied nor pickled" in str(error), error
        else:
            assert name == "Expression", name
    for make in (object.__new__, type(one).__new__):
        try:
            make(type(one))
        except TypeError:
            pass
        else:
            raise AssertionError(name)
print(*sorted(objects))
"""


def test_compiled_objects_can_neither_be_copied_nor_pickled():
    done = subprocess.run([sys.executable, "-c", COPIES], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert {"Model", "Motion", "PartExchange", "Record", "ResultFile", "Simulation"} <= set(done.stdout.split())


def test_every_compiled_class_says_how_it_is_copied():
    assert [name for name, one in CLASSES.items() if "__reduce__" not in vars(one)] == []


@pytest.mark.parametrize("text", ["é", "impact é", "→", "\U0001d6fc", "impact^é", "\x1b"])
def test_signatures_with_other_characters_are_refused_with_a_message(text):
    with pytest.raises(graze.InputError) as refused:
        graze.orbit(graze.Model.shipped("impact-oscillator", omega=2.75), signature=text)
    assert refused.value.remedy
    assert "\x1b" not in refused.value.problem
    if text != "impact^é":
        assert f"'{text[-1]}' does not belong into a signature" in refused.value.problem or text == "\x1b"


def test_paths_with_a_zero_byte_are_refused(tmp_path):
    orbit = graze.orbit(graze.Model.shipped("impact-oscillator", omega=2.75))
    path = str(tmp_path / "orbit.sqlite")
    orbit.save(path)
    with pytest.raises((graze.InputError, ValueError)):
        orbit.save(str(tmp_path / "other.sqlite") + "\0ignored")
    with pytest.raises((graze.InputError, ValueError)):
        graze.read_results(path + "\0ignored")
    with pytest.raises(graze.InputError, match="zero byte"):
        _graze.ResultFile(path + "\0ignored", write=False)
    assert not list(tmp_path.glob("other*"))


@pytest.fixture(scope="module")
def cycle_map():
    return graze.run_study("mems-switch", only=["free", "no_impact"])["no_impact"]["GR1"].grazing().cycle_map


def test_the_number_of_projections_is_limited(cycle_map):
    assert len(cycle_map.projections(1000)) == 1000
    for count in (10**10, 2**63):
        with pytest.raises((graze.InputError, ValueError)):
            cycle_map.projections(count)


class Alarm(Exception):
    pass


def seconds_after_alarm(call, delay=0.2):
    """How long a call goes on after a signal whose handler raises an error."""

    def ring(number, frame):
        raise Alarm

    before = signal.signal(signal.SIGALRM, ring)
    try:
        rings = time.monotonic() + delay
        signal.setitimer(signal.ITIMER_REAL, delay)
        with pytest.raises(Alarm):
            call()
        return time.monotonic() - rings
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


LONGEST = 1  # seconds, on a machine that does other things too


def test_queries_can_be_interrupted():
    run = graze.orbit(graze.Model.shipped("impact-oscillator", omega=2.75))
    assert seconds_after_alarm(lambda: run.query(ENDLESS)) < LONGEST
    assert len(run.query("SELECT 1 AS one")) == 1


def test_motions_of_maps_can_be_interrupted(cycle_map):
    many = 10**7
    assert seconds_after_alarm(lambda: cycle_map.motion(-1e-3, transient=many, cycles=many)) < LONGEST
    assert seconds_after_alarm(lambda: cycle_map.motion(-1e-3, transient=0, cycles=many)) < LONGEST


def test_spectra_can_be_interrupted():
    samples = 3_000_000
    times = numpy.arange(samples) * 1e-3
    record = graze.MeasuredRecord(times, {"x": numpy.sin(times)})
    assert seconds_after_alarm(lambda: record.spectrum("x"), 0.5) < LONGEST
    assert seconds_after_alarm(lambda: record.spectrum("x", part=samples), 0.5) < LONGEST


def test_the_base_class_of_compiled_objects_has_no_objects():
    base = graze._graze.Model.__mro__[1]
    for make in (base, lambda: base.__new__(base), lambda: object.__reduce__(graze.load("bouncing-ball")._core)[0](base)):
        with pytest.raises(TypeError):
            make()
    assert graze.load("bouncing-ball")._core.name == "bouncing-ball"
