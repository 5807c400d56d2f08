"""Runs computed by executors are the same, to the last bit, as those computed by one thread."""

import multiprocessing
import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import textwrap
import threading
import time
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor, ThreadPoolExecutor

import pytest

import graze
from graze import _executors, _graze


def rows_of(path):
    """All rows of a result file, in their order; numbers as their hexadecimal digits."""
    connection = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
    tables = [name for name, in connection.execute("SELECT name FROM sqlite_master WHERE type = 'table' AND name <> 'meta'"
                                                   " ORDER BY name")]
    rows = {}
    for table in tables:
        rows[table] = [tuple(cell.hex() if isinstance(cell, float) else cell for cell in row)
                       for row in connection.execute(f'SELECT * FROM "{table}"')]
    connection.close()
    return rows


def bits(run):
    run._store.file.flush()
    return rows_of(run._store.path)


def same(run, other):
    assert run.status == other.status == "complete"
    assert run.points == other.points
    assert run.samples == other.samples
    assert bits(run) == bits(other)


@pytest.fixture(scope="module")
def oscillator():
    return graze.Model.shipped("impact-oscillator")


RUNS = {
    "sweep": (graze.sweep, dict(vary={"omega": (2.7, 2.9, 6), "sigma": [1.2, 1.25, 1.3, 1.35]}, direction="both", cycles=60)),
    "basin": (graze.basin, dict(vary={"x": {"random": [-1, 0]}, "omega": [2.7, 2.8]}, draws=40, cycles=60)),
    "ensemble": (graze.ensemble, dict(vary={"v": (-2, 2, 31)}, periods=12, bounds={"x": [-1, 2]})),
}


def made(kind, model, **options):
    function, keys = RUNS[kind]
    return function(model, **keys, **options)


@pytest.fixture(scope="module")
def by_one_thread(oscillator):
    return {kind: made(kind, oscillator, threads=1) for kind in RUNS}


def longer(model, **options):
    """A basin that takes long enough to be interrupted: some seconds of one core."""
    return graze.basin(model, vary={"x": (-1.2, 0.1, 60), "v": (-1, 1, 50)}, set={"omega": 2.75}, cycles=300, **options)


@pytest.fixture(scope="module")
def longer_by_one_thread(oscillator):
    return longer(oscillator, threads=1)


def pool(method):
    return ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(method))


@pytest.mark.parametrize("method", ["spawn", "fork"])
def test_a_process_pool_gives_the_same_bits(oscillator, by_one_thread, method):
    with pool(method) as executor:
        for kind in RUNS:
            same(made(kind, oscillator, executor=executor), by_one_thread[kind])


def test_a_thread_pool_gives_the_same_bits(oscillator, by_one_thread):
    with ThreadPoolExecutor(3) as executor:
        for kind in RUNS:
            same(made(kind, oscillator, executor=executor), by_one_thread[kind])


def killing(executor):
    """A function of progress that kills one process of a pool when something is done."""
    def kill(state):
        if state["done"] > 20:
            for process in list(executor._processes.values())[:1]:
                os.kill(process.pid, signal.SIGKILL)

    return kill


class Here:
    """An executor that does what it is given at once, and counts. `fails` is called with each task's number."""

    _max_workers = 1

    def __init__(self, fails=lambda number: None):
        self.fails = fails
        self.tasks = 0
        self.seconds = []

    def submit(self, function, *arguments):
        future = Future()
        self.tasks += 1
        failure = self.fails(self.tasks)
        if failure is not None:
            future.set_exception(failure)
            return future
        try:
            future.set_result(function(*arguments))
            self.seconds.append(future.result()[0])
        except Exception as error:
            future.set_exception(error)
        return future


@pytest.mark.parametrize("name", graze.models())
def test_every_model_is_the_same_after_its_way_through_a_text(name):
    model = graze.Model.shipped(name)
    state = model.states[0].name
    value = float(model.initial[state])
    keys = dict(vary={state: [value, value + 1e-3 * (abs(value) or 1)]}, contacts=5)
    run = graze.ensemble(model, threads=1, **keys)
    same(graze.ensemble(model, executor=Here(), **keys), run)


def test_points_that_carry_no_state_are_parts_of_their_own(oscillator):
    keys = dict(vary={"omega": (2.7, 2.9, 11)}, direction="both", cycles=60, carry=False)
    executor = Here()
    same(graze.sweep(oscillator, executor=executor, **keys), graze.sweep(oscillator, threads=1, **keys))
    assert executor.tasks > 2
    executor = Here()
    graze.sweep(oscillator, executor=executor, **{**keys, "carry": True})
    assert executor.tasks == 1  # one chain


def test_what_is_no_part_is_refused(oscillator):
    texts = []
    executor = Here()
    executor.submit = lambda function, text, *rest: texts.append((text, *rest)) or Here.submit(executor, function, text, *rest)
    made("basin", oscillator, executor=executor)
    text, part, _ = texts[0]
    worker = _graze.PartWorker(text)
    assert worker.computed(part) == worker.computed(part) != b""
    with pytest.raises(graze.InputError, match="of graze older-"):
        _graze.PartWorker(text.replace(b'"version":"', b'"version":"older-'))
    for wrong in (b"", part[:-1], part + b"x", b"\xff" * 40):
        with pytest.raises(graze.InputError):
            worker.computed(wrong)
        with pytest.raises(graze.InputError):
            _graze.PartWorker(wrong)
    assert _graze.PartExchange().part(0, 5, 2) == b""  # no run is open
    assert _graze.PartExchange().give(0, 0, 1, b"x") is None


def test_points_that_do_not_belong_to_a_part_fail_the_run(oscillator):
    class Wrong(Here):
        def submit(self, function, *arguments):
            future = Future()
            future.set_result((0.1, b"graze points 1\n"))
            return future

    with pytest.raises(graze.RunFailed, match="no part of a computation"):
        made("basin", oscillator, executor=Wrong())


def test_a_study_is_the_same(tmp_path):
    (tmp_path / "s.toml").write_text(textwrap.dedent("""
        name = "s"
        model = "impact-oscillator"
        [runs.orbit]
        kind = "orbit"
        set = { omega = 4 }
        from = { x = -0.07 }
        [runs.sweep]
        kind = "sweep"
        vary = { omega = { from = 2.7, to = 2.9, points = 6 } }
        cycles = 60
        [runs.basin]
        kind = "basin"
        vary = { x = { from = -1, to = 0, points = 9 } }
        cycles = 60
        start = { run = "sweep", at = { omega = 2.8 } }
        [runs.motions]
        kind = "simulate"
        vary = { v = { from = -2, to = 2, points = 9 } }
        periods = 5
        start = { run = "orbit" }
        """))
    graze.run_study(tmp_path / "s.toml", output=tmp_path / "one", threads=1)
    with ThreadPoolExecutor(2) as executor:
        told = []
        done = graze.run_study(tmp_path / "s.toml", output=tmp_path / "other", executor=executor, progress=told.append)
        assert [report["computed"] for report in done.reports] == [1, 6, 9, 9]
        assert told[-1]["all_done"] <= told[-1]["all_points"]
        again = graze.run_study(tmp_path / "s.toml", output=tmp_path / "other", executor=executor)
    assert [report["computed"] for report in again.reports] == [0, 0, 0, 0]
    assert rows_of(tmp_path / "one" / "results.sqlite") == rows_of(tmp_path / "other" / "results.sqlite")


def test_an_interrupted_run_is_resumed_to_the_same_bits(oscillator, longer_by_one_thread):
    def stop(state):
        if state["done"] > 20:
            raise KeyboardInterrupt

    with pool("fork") as executor:
        with pytest.raises(graze.Interrupted) as told:
            longer(oscillator, executor=executor, progress=stop)
        run = told.value.run
        assert run.status == "unfinished"
        assert 20 < len(run.points) < 3000
        before = run.points
        with pytest.raises(graze.Interrupted):
            run.resume(threads=1, progress=lambda state: stop({"done": state["done"] - 100}))
        assert len(run.points) > len(before)
        assert run.resume(executor=executor) is run
    assert run.report["computed"] < 3000
    same(run, longer_by_one_thread)
    assert run.resume().report["computed"] == 0
    with pytest.raises(graze.InputError):
        graze.read_results(run._store.path)["basin1"].resume()


def test_ctrl_c_ends_a_run_soon(oscillator):
    with ThreadPoolExecutor(1) as executor:
        asked = []

        def interrupt():
            asked.append(time.monotonic())
            signal.raise_signal(signal.SIGINT)

        threading.Timer(0.5, interrupt).start()
        with pytest.raises(graze.Interrupted):
            longer(oscillator, executor=executor)
        assert time.monotonic() - asked[0] < 0.5  # 0.1 s where the machine is free
        while executor._work_queue.qsize() > 0:
            assert executor._work_queue.get().future.cancelled()


def test_a_lost_process_is_told_and_the_run_goes_on_with_another_pool(oscillator, longer_by_one_thread):
    with pool("spawn") as executor:
        with pytest.raises(graze.WorkersLost) as told:
            longer(oscillator, executor=executor, progress=killing(executor))
        assert "another executor" in told.value.remedy
        run = told.value.run
        kept = len(run.points)
        assert 20 < kept < 3000
        with pytest.raises(graze.WorkersLost):  # it is of no use any more
            run.resume(executor=executor)
    with pool("fork") as other:
        run.resume(executor=other)
    assert run.report["computed"] == 3000 - kept
    same(run, longer_by_one_thread)


def test_parts_whose_worker_is_lost_are_given_out_again(oscillator, by_one_thread):
    lost = {1: ConnectionError("gone"), 2: CancelledError(), 4: OSError("gone too")}
    same(made("basin", oscillator, executor=Here(lost.get)), by_one_thread["basin"])
    executor = Here(lambda number: ConnectionError("gone") if number > 3 else None)
    with pytest.raises(graze.WorkersLost) as told:
        made("basin", oscillator, executor=executor)
    assert "4 times" in told.value.problem and "ConnectionError: gone" in told.value.problem
    assert 0 < len(told.value.run.points) < 80
    same(told.value.run.resume(), by_one_thread["basin"])


def test_a_run_that_fails_says_the_same(oscillator):
    turn = "period = 6.283185307179586"
    assert turn in str(oscillator)
    model = graze.Model(text=str(oscillator).replace(turn, 'period = "2*pi*zeta"'))
    keys = dict(vary={"zeta": [0.1, -0.1]}, periods=2)
    with pytest.raises(graze.RunFailed) as one:
        graze.ensemble(model, threads=1, **keys)
    with pytest.raises(graze.RunFailed) as other:
        graze.ensemble(model, executor=Here(), **keys)
    assert (one.value.problem, one.value.remedy) == (other.value.problem, other.value.remedy)


DASK = """
    import os, signal, sys
    from distributed import Client, LocalCluster
    import graze
    from test_executors import longer, made, RUNS

    def killed(state):
        if state["done"] > 20 and not gone:
            gone.append(next(iter(cluster.workers.values())).pid)
            os.kill(gone[0], signal.SIGKILL)

    if __name__ == "__main__":
        gone = []
        oscillator = graze.Model.shipped("impact-oscillator")
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, host="127.0.0.1") as cluster:
            with Client(cluster) as client:
                executor = client.get_executor()
                for kind in RUNS:
                    made(kind, oscillator, executor=executor).save(os.path.join(sys.argv[1], kind))
                longer(oscillator, executor=executor, progress=killed).save(os.path.join(sys.argv[1], "killed"))
        assert gone
    """

MPI = """
    import os, sys
    from mpi4py.futures import MPIPoolExecutor
    import graze
    from test_executors import made, RUNS

    if __name__ == "__main__":
        with MPIPoolExecutor() as executor:
            for kind in RUNS:
                made(kind, graze.Model.shipped("impact-oscillator"), executor=executor).save(os.path.join(sys.argv[1], kind))
            assert graze._executors.number_of_workers(executor) == 2
    """


def carried_out(command, script, folder):
    path = folder / "script.py"
    path.write_text(textwrap.dedent(script))
    places = [os.path.dirname(__file__), os.path.dirname(os.path.dirname(graze.__file__))]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(places), "OMPI_ALLOW_RUN_AS_ROOT": "1",
                   "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run([*command, path, folder], env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_dask_cluster_gives_the_same_bits_though_a_worker_is_killed(tmp_path, by_one_thread, longer_by_one_thread):
    pytest.importorskip("distributed")
    carried_out([sys.executable], DASK, tmp_path)
    for kind in RUNS:
        assert rows_of(tmp_path / kind) == bits(by_one_thread[kind])
    assert rows_of(tmp_path / "killed") == bits(longer_by_one_thread)


def test_mpi_gives_the_same_bits(tmp_path, by_one_thread):
    pytest.importorskip("mpi4py.futures")
    if shutil.which("mpiexec") is None:
        pytest.skip("there is no mpiexec")
    carried_out(["mpiexec", "-n", "3", "--oversubscribe", sys.executable, "-m", "mpi4py.futures"], MPI, tmp_path)
    for kind in RUNS:
        assert rows_of(tmp_path / kind) == bits(by_one_thread[kind])


def test_what_is_no_executor_is_refused(oscillator):
    with pytest.raises(graze.InputError, match="executor is of type int"):
        made("basin", oscillator, executor=4)
    closed = ThreadPoolExecutor(1)
    closed.shutdown()
    with pytest.raises(graze.WorkersLost, match="takes no work"):
        made("basin", oscillator, executor=closed)


@pytest.mark.parametrize("chains, seconds, workers", [(1, 1.0, 4), (7, 0.2, 64), (1000, 0.01, 8), (100_000, 1e-4, 2),
                                                      (300, 5.0, 3)])
def test_parts_take_about_half_a_second_and_end_together(chains, seconds, workers):
    ranges = [(0, chains // 3), (chains // 3, chains)] if chains > 3 else [(0, chains)]
    run = _executors._OpenWork(0, b"", ranges)
    free = [0.0] * workers  # when each is free
    going, parts = [], []
    while run.has_more():
        free.sort()
        now = free.pop(0)
        for end, part in [one for one in going if one[0] <= now]:
            run.note(part, (part.last - part.first) * seconds)
        going = [one for one in going if one[0] > now]
        first, last = run.sizes.cut(workers)
        parts.append(_executors._Part(run, first, last, b""))
        free.append(now + (last - first) * seconds)
        going.append((free[-1], parts[-1]))
    for end, part in going:
        run.note(part, (part.last - part.first) * seconds)
    assert run.open == 0
    assert sorted(one for part in parts for one in range(part.first, part.last)) == list(range(chains))
    sizes = [part.last - part.first for part in parts]
    assert all(size * seconds <= 0.5 * (1 + 1e-9) or size == 1 for size in sizes)
    assert max(free) - min(free) <= max(0.5, seconds) or chains < 2 * workers
    small = [size for size in sizes if size * seconds < 0.09 and size < chains]
    assert len(small) <= 8 * workers + 2  # the first ones, and the ends of ranges
