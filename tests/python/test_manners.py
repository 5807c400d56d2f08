"""Interruptions, progress, threads and memory."""

import gc
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest

import graze

# What a child process does before, after an interruption has ended the computation. It prints when that was.
CHILD = """
import sys, time
import graze
told = False
def ready(*state):
    global told
    if not told:
        told = True
        print("ready", flush=True)
{setup}
try:
    {call}
    print("not interrupted")
except graze.Interrupted as stopped:
    print(time.clock_gettime(time.CLOCK_MONOTONIC), flush=True)
    run = stopped.run
    {after}
"""
OSCILLATOR = 'oscillator = graze.Model.shipped("impact-oscillator", omega=2.8)'


def interrupted_child(call, setup, after, *, signalled=signal.SIGINT):
    """Interrupts a call in a child process. Returns the seconds that it took to end, and what it printed then."""
    text = CHILD.format(setup=setup, call=call, after=after)
    with subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "ready\n", child.stderr.read()
        time.sleep(0.15)
        sent = time.clock_gettime(time.CLOCK_MONOTONIC)
        child.send_signal(signalled)
        output, problems = child.communicate(timeout=60)
    assert child.returncode == 0, problems
    ended, *rest = output.splitlines()
    return float(ended) - sent, rest


INTERRUPTED = {
    "simulate": ("graze.simulate(oscillator, periods=10**8, samples=100, progress=ready)", OSCILLATOR,
                 'print(run.ending, len(run.samples) > 0, run.end_time > 0, stopped.motion is run, run.regular)',
                 ["interrupted True True True False"]),
    "transient": ("graze.simulate(oscillator, skip=10**8, periods=1, samples=100, progress=ready)", OSCILLATOR,
                  'print(run.ending, len(run.samples), run.end_time > 0)', ["interrupted 0 True"]),
    "simulation": ("graze.Simulation(oscillator).run(periods=10**8, samples=0, progress=ready)", OSCILLATOR,
                   "print(run.ending)", ["interrupted"]),
    "sweep": ("graze.sweep(oscillator, vary={'omega': (2.7, 2.8, 20000)}, cycles=200, progress=ready)", OSCILLATOR,
              "print(run.status, 0 <= len(run.points) < 20000)", ["unfinished True"]),
    "branch": ("rest.follow(omega=(2.2, 4.5), direction='down', step={'first': 1e-6, 'largest': 1e-6}, steps=100000, progress=ready)",
               OSCILLATOR + "\nrest = graze.orbit(oscillator, set={'omega': 4}, from_={'x': -0.07})",
               "print(run.status, run.kind)", ["unfinished continue"]),
    "ensemble": ("graze.ensemble(oscillator, vary={'omega': (2.7, 2.8, 20000)}, periods=2000, progress=ready)", OSCILLATOR,
                 "print(run.status, 0 <= len(run.points) < 20000)", ["unfinished True"]),
}


@pytest.mark.parametrize("what", INTERRUPTED)
def test_ctrl_c_ends_computations_and_keeps_what_was_computed(what):
    call, setup, after, expected = INTERRUPTED[what]
    seconds, output = interrupted_child(call, setup, after)
    print(f"{what}: {seconds:.3f} s")
    assert output == expected
    assert seconds < 1


def test_an_interrupted_study_goes_on_where_it_stopped(tmp_path):
    study = tmp_path / "long.toml"
    study.write_text('name = "long"\nmodel = "impact-oscillator"\n[runs.a]\nkind = "sweep"\ncycles = 80\n'
                     'vary = { omega = { from = 2.7, to = 2.8, points = 3000 } }\n')
    seconds, (count,) = interrupted_child(f"graze.run_study({str(study)!r}, output={str(tmp_path / 'out')!r}, progress=ready)",
                                          "", "print(len(run['a'].points))")
    print(f"study: {seconds:.3f} s")
    assert seconds < 1
    assert int(count) < 3000

    def enough(state):
        return state["done"] < int(count) + 20

    with pytest.raises(graze.Interrupted) as stopped:
        graze.run_study(study, output=tmp_path / "out", progress=enough)
    assert len(stopped.value.run["a"].points) >= int(count)


def test_a_handler_of_signals_may_raise_its_own_error():
    class Alarm(Exception):
        pass

    def ring(number, frame):
        raise Alarm

    before = signal.signal(signal.SIGALRM, ring)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Alarm):
            graze.simulate(graze.Model.shipped("impact-oscillator"), periods=10**8, samples=0)
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(Alarm):
            graze.sweep(graze.Model.shipped("impact-oscillator"), vary={"omega": (2.7, 2.8, 20000)}, cycles=200)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_progress_that_returns_false_stops_and_keeps_what_was_computed():
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    told = []

    def stop(fraction, time):
        told.append((fraction, time))
        return len(told) < 3

    with pytest.raises(graze.Interrupted) as stopped:
        graze.simulate(model, time=1e9, samples=0, progress=stop)
    assert len(told) == 3
    assert all(0 <= fraction < 1 for fraction, _ in told)
    assert told == sorted(told)
    motion = stopped.value.motion
    assert motion.ending == "interrupted"
    assert motion.end_time >= told[-1][1] * (1 - 1e-15)  # both are sums of the same times, rounded otherwise
    # What was computed is the beginning of the motion.
    exact = graze.simulate(model, contacts=5, samples=0).contacts
    assert motion.contacts.rows(slice(0, 5)) == exact
    # Without a known length the fraction is unknown.
    fractions = []
    with pytest.raises(graze.Interrupted):
        graze.simulate(graze.Model.shipped("electromagnetic-testbed"), contacts=10**8, samples=0,
                       progress=lambda fraction, time: fractions.append(fraction) or False)
    assert 0 <= fractions[0] < 1

    states = []

    def enough(state):
        states.append(state)
        return state["done"] == 0

    with pytest.raises(graze.Interrupted) as stopped:
        graze.sweep(model, vary={"omega": (2.7, 2.8, 20000)}, cycles=80, progress=enough)
    run = stopped.value.run
    assert run.status == "unfinished"
    assert states[-1]["points"] == 20000
    assert 0 < states[-1]["done"] <= len(run.points) < 20000


def test_progress_may_be_true_or_a_function_only(monkeypatch, capsys):
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    pytest.importorskip("tqdm")
    with_bar = graze.simulate(model, periods=20_000, samples=0, events=[], progress=True)
    assert "time" in capsys.readouterr().err
    swept = graze.sweep(model, vary={"omega": (2.7, 2.8, 5)}, cycles=80, progress=True)
    assert len(swept.points) == 5
    for name in list(sys.modules):
        if name.split(".")[0] == "tqdm":
            monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    without_bar = graze.simulate(model, periods=20_000, samples=0, events=[], progress=True)
    assert "time" not in capsys.readouterr().err
    assert without_bar.end_state == with_bar.end_state
    for wrong in (1, "yes", [True]):
        with pytest.raises(TypeError):
            graze.simulate(model, time=1, progress=wrong)


def test_other_threads_run_while_one_computes():
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    stop = threading.Event()
    ended = []

    def compute():
        try:
            graze.simulate(model, periods=10**8, samples=0, events=[], progress=lambda *_: not stop.is_set())
        except graze.Interrupted as stopped:
            ended.append(stopped.run)

    threads = [threading.Thread(target=compute) for _ in range(2)]
    for thread in threads:
        thread.start()
    count, end = 0, time.monotonic() + 0.5
    while time.monotonic() < end:
        count += 1
    stop.set()
    for thread in threads:
        thread.join()
    # A computation that kept the interpreter's lock would let this loop turn only some times a second.
    assert count > 1000
    assert len(ended) == 2
    assert all(motion.end_time > 0 for motion in ended)


def test_threads_share_simulations_and_models():
    """Many threads use the same objects; each result equals that of one thread, bit for bit."""
    model = graze.Model.shipped("impact-oscillator-two-stops")
    simulation = graze.Simulation(model, extrema=["x"], quantities=["v*v"])
    omegas = [model.parameters.omega * (1 + 0.01 * i) for i in range(4)]
    expected = [simulation.run(periods=30, set={"omega": omega}) for omega in omegas]
    problems = []

    def compute(number):
        for turn in range(10):
            i = (number + turn) % len(omegas)
            motion = simulation.run(periods=30, set={"omega": omegas[i]})
            other = graze.simulate(model, periods=30, set={"omega": omegas[i]}, extrema="x", quantities="v*v")
            if not all(getattr(one, table) == getattr(expected[i], table) for one in (motion, other)
                       for table in ("samples", "contacts", "extrema")):
                problems.append((number, turn))

    threads = [threading.Thread(target=compute, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not problems


def test_numbers_do_not_depend_on_threads():
    model = graze.Model.shipped("impact-oscillator")
    runs = [graze.basin(model, vary={"x": (-1.0, 0.0, 6), "v": (-1.0, 1.0, 6)}, cycles=100, threads=threads)
            for threads in (1, 2, 5)]
    assert runs[0].points == runs[1].points == runs[2].points
    for wrong in (0, -1, 1.5, "two", True, None.__class__):
        with pytest.raises((graze.InputError, TypeError)):
            graze.sweep(model, vary={"omega": [2.7]}, threads=wrong)


@pytest.mark.parametrize("call", ["graze.simulate(model, periods=10**8, samples=0)",
                                  "graze.sweep(model, vary={'omega': (2.7, 2.8, 20000)}, cycles=200)"])
def test_the_interpreter_may_end_while_a_daemon_thread_computes(call):
    text = textwrap.dedent(f"""
        import threading, time, graze
        model = graze.Model.shipped("impact-oscillator", omega=2.8)
        threading.Thread(target=lambda: {call}, daemon=True).start()
        time.sleep(0.5)
    """)
    ended = subprocess.run([sys.executable, "-c", text], timeout=60, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    assert ended.stderr == ""


def test_a_process_forked_while_a_thread_computes_works_and_ends():
    text = textwrap.dedent("""
        import os, sys, threading, time, graze
        model = graze.Model.shipped("impact-oscillator", omega=2.8)
        simulation = graze.Simulation(model)
        compute = lambda: simulation.run(periods=10**8, samples=0)
        threading.Thread(target=compute, daemon=True).start()
        time.sleep(0.2)
        child = os.fork()
        if child == 0:
            motion = graze.simulate(model, periods=3)
            sys.exit(0 if len(motion.contacts) > 0 else 1)
        begun = time.monotonic()
        print(os.waitpid(child, 0)[1], time.monotonic() - begun)
    """)
    ended = subprocess.run([sys.executable, "-c", text], timeout=60, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    status, seconds = ended.stdout.split()
    assert status == "0"
    assert float(seconds) < 5


def test_errors_and_interruptions_can_be_pickled():
    with pytest.raises(graze.ModelError) as told:
        graze.Model(text='name = "x"\n[states.q]\ninitial = "1 +"\n[modes.m]\nrates = { q = "2*z" }\n')
    error = told.value
    assert len(error.all) > 1
    assert error.all[0] is error
    assert len(str(error).splitlines()) == len(error.all)
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error)
    assert [(one.line, one.column) for one in again.all] == [(one.line, one.column) for one in error.all]
    stopped = pickle.loads(pickle.dumps(graze.Interrupted(5)))
    assert stopped.run == stopped.motion == 5
    assert pickle.loads(pickle.dumps(graze.Interrupted())).run is None


def resident() -> int:
    """Bytes of memory that this process has in use."""
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif("asan" in os.environ.get("LD_PRELOAD", ""), reason="the sanitizer keeps memory that was given back")
def test_memory_stays_flat_over_many_small_calls():
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    simulation = graze.Simulation(model, extrema="x", quantities="v*v")
    x, v = graze.symbols("x v")
    run = graze.sweep(model, vary={"omega": [2.7, 2.75]}, cycles=80)

    def wrong():
        try:
            simulation.run(time=1, mode="nowhere")
        except graze.InputError:
            return
        raise AssertionError

    def seen(motion):
        return motion.samples, motion.contacts, motion.extrema, motion.end_state

    calls = [
        (30_000, lambda: simulation.run(time=0.01, samples=0)),
        (5_000, lambda: seen(simulation.run(time=1.0, samples=5, dense=True, derivatives="x"))),
        (2_000, lambda: simulation.run(time=1.0, samples=2, dense=True)(0.5)),
        (2_000, lambda: graze.simulate(model, time=0.1, samples=2)),
        (30_000, lambda: (x + 2 * v) ** 2 / (1 + x)),
        (10_000, lambda: model.with_(omega=2.9)),
        (5_000, lambda: str(model)),
        (1_000, lambda: graze.Simulation(model.with_(x=0.01))),
        (10_000, wrong),
        (1_000, lambda: (run.points, run.samples)),
        (4_000, lambda: pickle.loads(pickle.dumps(x * v))),
    ]
    assert sum(number for number, _ in calls) >= 100_000

    def all_calls(share):
        for number, call in calls:
            for _ in range(max(1, int(number * share))):
                call()
        gc.collect()

    all_calls(0.2)  # fills what is kept for later, such as free memory
    before = resident()
    all_calls(1)
    grown = resident() - before
    print(f"memory has grown by {grown} bytes")
    # One byte a call that is not given back could not be seen; forty are.
    assert grown < 4_000_000


COMPUTING = {
    "simulate": lambda model: graze.simulate(model, periods=3), "orbit": lambda model: graze.orbit(model),
    "sweep": lambda model: graze.sweep(model, vary={"omega": [2.7]}), "run_study": lambda model: graze.run_study("mems-switch"),
    "design": lambda model: graze.design("mems-switch"), "layout": lambda model: graze.layout("mems-switch-device")}


@pytest.mark.parametrize("what", COMPUTING)
def test_ctrl_c_before_computing_begins_is_an_interruption_too(what, monkeypatch):
    def interrupted(*arguments, **keys):
        raise KeyboardInterrupt

    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    for place in ("graze._simulation.Simulation", "graze._runs.Ways", "graze._study.Ways", "graze._design.DesignText",
                  "graze._layout.DesignText"):
        monkeypatch.setattr(place, interrupted)
    with pytest.raises(graze.Interrupted) as stopped:
        COMPUTING[what](model)
    assert stopped.value.run is None
