"""What tells how far a computation is."""

from __future__ import annotations

from typing import Any, Callable, Optional, Tuple, Union

Progress = Union[None, bool, Callable[..., Any]]
"""True for a bar, a function that is called some times a second, or nothing."""


class Stopped(KeyboardInterrupt):
    """Raised where a function that is told how far a computation is returns False: it stops the computation as Ctrl-C
    does."""


def told_to(progress: Progress, unit: str) -> Tuple[Optional[Callable[..., None]], Callable[[], None]]:
    """A function for the compiled part (None: nothing is told), and one that ends the telling.

    progress: True shows tqdm's bar, where tqdm is installed; a function is called with what the unit says: for "time",
    with the finished fraction (None if unknown) and the time; for "point", with a dict of `run`, `done` and `points` (0
    if unknown), `all_done` and `all_points` of the study, and the `parameter` of the last orbit of a branch (or None).
    Where it returns False, the computation ends with `Interrupted`; what it raises ends the computation too.
    """
    if progress is None or progress is False:
        return None, _nothing
    if progress is not True:
        if not callable(progress):
            raise TypeError(f"progress must be True or a function, not {type(progress).__name__}")
        return _caller(progress, unit), _nothing
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None, _nothing
    if unit == "time":
        return _time_bar(tqdm)
    return _point_bar(tqdm)


def _nothing() -> None:
    pass


def _caller(progress: Callable[..., Any], unit: str) -> Callable[..., None]:
    def tell(*state: Any) -> None:
        if unit == "time":
            fraction, time = state
            state = (None if fraction < 0 else fraction, time)
        if progress(*state) is False:
            raise Stopped

    return tell


def _time_bar(tqdm: Any) -> Tuple[Callable[..., None], Callable[[], None]]:
    bar = tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}<{remaining}{postfix}")

    def tell(fraction: float, time: float) -> None:
        bar.set_postfix_str(f"time {time:.6g}", refresh=False)
        bar.n = max(fraction, 0.0)
        bar.refresh()

    return tell, bar.close


def _point_bar(tqdm: Any) -> Tuple[Callable[..., None], Callable[[], None]]:
    bar = tqdm(unit="point")

    def tell(state: Any) -> None:
        bar.total = state["points"] or None
        bar.n = state["done"]
        if state["parameter"] is not None:
            bar.set_postfix_str(f"at {state['parameter']:.6g}", refresh=False)
        bar.refresh()

    return tell, bar.close
