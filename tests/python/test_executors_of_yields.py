"""Yields whose devices are solved for by executors are the same, to the last bit, as those of one thread."""

import pickle
import sys
import time
from concurrent.futures import Future, ThreadPoolExecutor

import pytest

import graze
from graze import _graze
from test_executors import Here, carried_out, killing, pool

VARY = {"delta": "4%", "omega": (0.002, "uniform")}
QUICK = dict(points={"curve": 3, "plane": 2}, yield_={"devices": 60})


@pytest.fixture(scope="module")
def touch(tmp_path_factory):
    study = graze.run_study("mems-switch", output=tmp_path_factory.mktemp("switch"), only=["free", "no_impact"])
    return study["no_impact"]["GR1"]


def yield_of(touch, devices=400, **options):
    return touch.tolerance(vary=VARY, within=(0.19, 0.21), devices=devices, seed=7, **options)


def same(found, other):
    assert found.devices == other.devices
    assert found.statistics == other.statistics
    assert found.derivatives == other.derivatives
    assert found.problems == other.problems


@pytest.fixture(scope="module")
def by_one_thread(touch):
    return yield_of(touch, threads=1)


@pytest.mark.parametrize("method", ["spawn", "fork"])
def test_a_process_pool_gives_the_same_bits(touch, by_one_thread, method):
    with pool(method) as executor:
        same(yield_of(touch, executor=executor), by_one_thread)


def test_a_thread_pool_gives_the_same_bits_and_progress(touch, by_one_thread):
    told = []
    with ThreadPoolExecutor(3) as executor:
        same(yield_of(touch, executor=executor, progress=told.append), by_one_thread)
    done = [state["done"] for state in told]
    assert done == sorted(done) and {state["points"] for state in told} == {400}
    assert 0 < done[-1] <= 400


def test_a_dask_cluster_gives_the_same_bits(touch, by_one_thread, tmp_path):
    pytest.importorskip("distributed")
    touch._run._store.file.flush()
    script = f"""
        import pickle, sys
        from distributed import Client, LocalCluster
        import graze
        from test_executors_of_yields import yield_of

        if __name__ == "__main__":
            with LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None) as cluster:
                with Client(cluster) as client:
                    touch = graze.read_results({touch._run._store.path!r})["no_impact"]["GR1"]
                    found = yield_of(touch, executor=client.get_executor())
                    with open(sys.argv[1] + "/found", "wb") as file:
                        pickle.dump(found, file)
        """
    carried_out([sys.executable], script, tmp_path)
    same(pickle.loads((tmp_path / "found").read_bytes()), by_one_thread)


def test_an_interrupted_yield_has_the_devices_of_the_parts_that_came(touch):
    with ThreadPoolExecutor(2) as executor:
        with pytest.raises(graze.Interrupted) as told:
            yield_of(touch, 300_000, executor=executor, progress=lambda state: state["done"] < 20)
        some = told.value.run
        assert 20 <= len(some.devices) < 300_000 and some.mean > 0
        begun = time.monotonic()
        executor.shutdown(wait=True)  # parts that wait are cancelled
    assert time.monotonic() - begun < 5


def test_a_lost_process_is_told(touch):
    with pool("spawn") as executor:
        with pytest.raises(graze.WorkersLost) as told:
            yield_of(touch, 300_000, executor=executor, progress=killing(executor))
    assert "another executor" in told.value.remedy
    assert 20 < len(told.value.run.devices) < 300_000


def test_parts_whose_worker_is_lost_are_given_out_again(touch, by_one_thread):
    lost = {1: ConnectionError("gone"), 4: OSError("gone too")}
    same(yield_of(touch, executor=Here(lost.get)), by_one_thread)
    with pytest.raises(graze.WorkersLost) as told:
        yield_of(touch, executor=Here(lambda number: ConnectionError("gone")))
    assert len(told.value.run.devices) == 0


def test_what_is_no_part_is_refused(touch):
    given = []

    class Kept(Here):
        def submit(self, function, *arguments):
            given.append(arguments)
            return super().submit(function, *arguments)

    yield_of(touch, executor=Kept())
    text, part, _ = given[0]
    worker = _graze.PartWorker(text)
    assert worker.computed(part) == worker.computed(part) != b""
    version = graze.__version__.encode()
    assert version in text
    with pytest.raises(graze.InputError, match="part of a yield of graze"):
        _graze.PartWorker(text.replace(version, b"9" * len(version), 1))
    for wrong in (b"", part[:-1], part + b"x"):
        with pytest.raises(graze.InputError, match="no part of a computation"):
            worker.computed(wrong)
    with pytest.raises(graze.InputError):
        _graze.PartWorker(text[:-1])

    class Wrong(Here):
        def submit(self, function, *arguments):
            future = Future()
            future.set_result((0.1, b"graze-solved-1\n"))
            return future

    with pytest.raises(graze.InputError, match="no part of a computation"):
        yield_of(touch, executor=Wrong())
    with pytest.raises(graze.InputError, match="executor is of type int"):
        yield_of(touch, executor=4)


def test_a_design_is_the_same():
    one = graze.design("mems-switch", threads=1, **QUICK)
    with ThreadPoolExecutor(2) as executor:
        assert graze.design("mems-switch", executor=executor, **QUICK).report == one.report
    executor = Here()
    graze.design("mems-switch", executor=executor, **QUICK)
    assert executor.tasks > 2


def test_the_devices_of_wafers_are_the_same():
    drawing = graze.layout("mems-switch-device", **QUICK)
    one = drawing.wafers(3, seed=3, threads=1)
    assert any(isinstance(value, float) for value in one.devices["V"])
    with pool("spawn") as executor:
        wafers = drawing.wafers(3, seed=3, executor=executor)
        assert wafers.report == one.report and wafers.devices == one.devices and wafers.problems == one.problems
        with pytest.raises(graze.Interrupted):
            drawing.wafers(1000, executor=executor, progress=lambda text: not text.startswith("device"))
    with pytest.raises(graze.WorkersLost):
        drawing.wafers(1, executor=executor)  # after its shutdown
