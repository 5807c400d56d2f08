"""Work computed by executors: parts of it, as points of runs or devices of yields, are given to the workers, and what they
compute comes back as bytes."""

from __future__ import annotations

import os
import queue
import time
from collections import deque
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import contextmanager
from functools import lru_cache
from typing import Any, Deque, Dict, Iterator, List, Optional, Tuple

from . import _graze
from ._errors import Error, InputError, WorkersLost
from ._progress import Told

ATTEMPTS = 4  # at a part whose worker is lost


@lru_cache(maxsize=4)
def _worker_of(text: bytes) -> _graze.PartWorker:
    return _graze.PartWorker(text)


def computed_part(text: bytes, part: bytes, attempt: int) -> Tuple[float, bytes]:
    """What workers do: the seconds that it took, and what was computed for a part, as bytes.

    attempt: counts from 0; it makes a repeated task another one for executors that know a task by its arguments.
    """
    worker = _worker_of(text)
    begun = time.perf_counter()
    result = worker.computed(part)
    return time.perf_counter() - begun, result


def number_of_workers(executor: Executor) -> int:
    """How many tasks an executor does at once; the number of cores of this computer where it does not say."""
    client = getattr(executor, "_client", None)  # of dask.distributed
    try:
        number = sum(client.nthreads().values()) if client is not None else getattr(executor, "_max_workers")
    except Exception:
        number = None
    return number if isinstance(number, int) and number > 0 else os.cpu_count() or 1


class _Part:
    """Items `first` to `last` - 1 of open work."""

    def __init__(self, work: _OpenWork, first: int, last: int, content: bytes):
        self.work = work
        self.first = first
        self.last = last
        self.content = content
        self.attempt = 0


class _OpenWork:
    """Work that waits for its items: a run for its chains, or a yield for its devices. It is cut into parts as workers
    become free."""

    def __init__(self, number: int, text: bytes, ranges: List[Tuple[int, int]]):
        self.number = number
        self.text = text
        self.sizes = _graze.PartSizes(ranges)
        self.open = sum(last - first for first, last in ranges)  # items that have not come
        self.is_closed = False

    def has_more(self) -> bool:
        return self.sizes.has_more and not self.is_closed

    def note(self, part: _Part, seconds: float) -> None:
        self.open -= part.last - part.first
        self.sizes.note(part.last - part.first, seconds)


def check_executor(executor: Executor) -> None:
    """Raises InputError for what is no executor."""
    if not callable(getattr(executor, "submit", None)):
        raise InputError(f"executor is of type {type(executor).__name__}, which cannot be given work",
                         "give a concurrent.futures.Executor, as a ProcessPoolExecutor or client.get_executor()")


class Parts:
    """Has items of work computed by an executor, while the compiled part carries it out with `exchange`.

    `look` is to be called now and then by the thread that has called from Python: all that is done with the executor is
    done there. `close` ends it: what waits is cancelled, and what is finished has been kept.
    """

    def __init__(self, executor: Executor):
        check_executor(executor)
        self.exchange = _graze.PartExchange()
        self._executor = executor
        self._works: Dict[int, _OpenWork] = {}
        self._going: Dict[Future, _Part] = {}
        self._ended: queue.SimpleQueue[Future] = queue.SimpleQueue()  # filled by threads of the executor
        self._again: Deque[_Part] = deque()  # whose worker was lost
        self._workers = 1
        self._counted: Optional[float] = None  # when workers were counted

    def look(self) -> None:
        """Takes what has come and hands out more."""
        for number, text, ranges in self.exchange.opened():
            self._works[number] = _OpenWork(number, text, ranges)
        while True:
            try:
                self._take(self._ended.get_nowait())
            except queue.Empty:
                break
        self._submit()

    def close(self) -> None:
        for future in list(self._going):
            future.cancel()
        self._going.clear()

    def _take(self, future: Future) -> None:
        part = self._going.pop(future, None)
        if part is None:
            return
        work = part.work
        try:
            seconds, result = future.result()
        except Error as error:
            self._works.pop(work.number, None)
            self.exchange.fail(work.number, error.problem, error.remedy, error.file, error.line, error.column)
        except BrokenExecutor as error:
            raise self._broken(error) from error
        except (Exception, CancelledError) as error:
            part.attempt += 1
            if part.attempt >= ATTEMPTS:
                raise WorkersLost(
                    f"a part of the work was given to workers {ATTEMPTS} times and came back without a result: "
                    f"{type(error).__name__}: {error}",
                    "look at what the workers print: each has to import the same version of graze, and needs memory for "
                    "a part") from error
            self._again.append(part)
        else:
            if work.number in self._works:
                self.exchange.give(work.number, part.first, part.last, result)
                work.note(part, seconds)
                if work.open == 0:
                    del self._works[work.number]

    def _broken(self, error: Exception) -> WorkersLost:
        return WorkersLost(f"the executor lost a worker and does nothing more: {error}",
                           "go on with another executor: what was computed is kept. Workers may have run out of memory, or "
                           "may have ended with the script's own code: guard that by if __name__ == \"__main__\"")

    def _count_workers(self) -> None:
        if self._counted is None or time.monotonic() > self._counted + 2:
            self._workers = number_of_workers(self._executor)
            self._counted = time.monotonic()

    def _next(self) -> Optional[_Part]:
        """The next part that is to be computed; None: all are given out."""
        while self._again:
            part = self._again.popleft()
            if part.work.number in self._works:
                return part
        for work in self._works.values():
            if work.has_more():
                first, last = work.sizes.cut(self._workers)
                content = self.exchange.part(work.number, first, last)
                if content:
                    return _Part(work, first, last, content)
                work.is_closed = True
        return None

    def _submit(self) -> None:
        if not self._again and not any(work.has_more() for work in self._works.values()):
            return
        self._count_workers()
        while len(self._going) < 2 * self._workers + 1:
            part = self._next()
            if part is None:
                return
            try:
                future = self._executor.submit(computed_part, part.work.text, part.content, part.attempt)
            except BrokenExecutor as error:
                raise self._broken(error) from error
            except RuntimeError as error:  # after its shutdown
                raise WorkersLost(f"the executor takes no work: {error}", "use it before its shutdown") from error
            self._going[future] = part
            future.add_done_callback(self._ended.put)


@contextmanager
def handed_out(executor: Optional[Executor], told: Told) -> Iterator[Tuple[Optional[_graze.PartExchange], Told]]:
    """What the compiled part is given while it carries out work, of which an executor computes what can be computed in
    parts: the exchange of parts, and the function that it calls as it goes on. Without an executor None, and `told`."""
    if executor is None:
        yield None, told
        return
    parts = Parts(executor)

    def look(*state: Any) -> None:
        parts.look()
        if told:
            told(*state)

    try:
        yield parts.exchange, look
    finally:
        parts.close()
