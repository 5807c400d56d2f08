"""What tells how far a computation is."""

from __future__ import annotations

from contextlib import contextmanager
from typing import Any, Callable, Iterator, Optional, Union

from ._errors import Interrupted, WorkersLost

Progress = Union[None, bool, Callable[..., Any]]
"""True for a bar, a function that is called some times a second, or nothing."""

Told = Optional[Callable[..., None]]
"""A function for the compiled part; None: nothing is told."""


class Stopped(KeyboardInterrupt):
    """Raised where a function that is told how far a computation is returns False: it stops the computation as Ctrl-C
    does."""


def check_progress(progress: Progress) -> None:
    """Raises TypeError for what is no progress."""
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        raise TypeError(f"progress must be True or a function, not {type(progress).__name__}")


@contextmanager
def telling(progress: Progress, unit: str) -> Iterator[Told]:
    """A function for the compiled part that tells how far it is, for as long as a computation lasts.

    progress: True shows tqdm's bar, where tqdm is installed; a function is called with what the unit says: for "time",
    with the finished fraction (None if unknown) and the time; for "point", with a dict of `run`, `done` and `points` (0
    if unknown), `all_done` and `all_points` of the study, and the `parameter` of the last orbit of a branch (or None);
    for "text", with a text; for "record", with a dict (see `acquire`). Where it returns False, the computation ends with
    `Interrupted`; what it raises ends the computation too.
    """
    check_progress(progress)
    if progress is None or progress is False:
        yield None
    elif progress is not True:
        yield _caller(progress, unit)
    else:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            tqdm = None
        if tqdm is None:
            yield None
            return
        bar = tqdm(**_BARS[unit])
        try:
            yield _SHOWN[unit](bar)
        finally:
            bar.close()


@contextmanager
def attended(progress: Progress, unit: str, kept: Callable[[], Any] = lambda: None) -> Iterator[Told]:
    """The same for a computation that Ctrl-C ends with Interrupted, or the loss of an executor's workers. kept: gives what
    was computed until then."""
    with telling(progress, unit) as told:
        try:
            yield told
        except KeyboardInterrupt:
            raise Interrupted(kept()) from None
        except WorkersLost as error:
            error.run = kept()
            raise


@contextmanager
def interruptible() -> Iterator[None]:
    """Ctrl-C inside is Interrupted, also where nothing is computed yet: a decorator of functions that compute."""
    try:
        yield
    except Interrupted:
        raise
    except KeyboardInterrupt as error:
        if type(error) in (KeyboardInterrupt, Stopped):  # a handler of signals may raise its own kind
            raise Interrupted() from None
        raise


def _caller(progress: Callable[..., Any], unit: str) -> Callable[..., None]:
    def tell(*state: Any) -> None:
        if unit == "time":
            fraction, time = state
            state = (None if fraction < 0 else fraction, time)
        if progress(*state) is False:
            raise Stopped

    return tell


def _time_shown(bar: Any) -> Callable[..., None]:
    def tell(fraction: float, time: float) -> None:
        bar.set_postfix_str(f"time {time:.6g}", refresh=False)
        bar.n = max(fraction, 0.0)
        bar.refresh()

    return tell


def _point_shown(bar: Any) -> Callable[..., None]:
    def tell(state: Any) -> None:
        bar.total = state["points"] or None
        bar.n = state["done"]
        if state["parameter"] is not None:
            bar.set_postfix_str(f"at {state['parameter']:.6g}", refresh=False)
        bar.refresh()

    return tell


def _text_shown(bar: Any) -> Callable[..., None]:
    def tell(text: str) -> None:
        bar.set_description_str(text)

    return tell


def _record_shown(bar: Any) -> Callable[..., None]:
    def tell(state: Any) -> None:
        bar.total, bar.n = state["levels"] or None, state["recorded"]
        bar.set_postfix_str(f"{state['stage']} {state['frequency']:g} Hz, {state['amplitude']:g} V", refresh=False)
        bar.refresh()

    return tell


_BARS = {"time": {"total": 1.0, "bar_format": "{l_bar}{bar}| {elapsed}<{remaining}{postfix}"}, "point": {"unit": "point"},
         "text": {"bar_format": "{desc} {elapsed}"}, "record": {"unit": "record"}}
_SHOWN = {"time": _time_shown, "point": _point_shown, "text": _text_shown, "record": _record_shown}
