"""What analyses of points have in common: how mistakes are told, and results that are drawn."""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import Any, Dict, Iterator, List, Optional

from ._errors import Error, InputError, OrderError, relocated
from ._table import Table

_ARGUMENTS = {"parameter", "until", "greatest_speed", "overshoot", "disturbance", "beside", "ramp", "wave", "wave_period",
              "noise", "memory", "at", "vary", "within", "devices", "seed", "rungs", "quantities", "run", "type", "cycles",
              "motions", "samples", "verify", "all", "threads", "state", "clearance", "transient", "count"}


@contextmanager
def called(name: str) -> Iterator[None]:
    """Errors inside get the name of the function and of the argument as their place; options of the program are called as
    the arguments are."""

    def place_of(one: Error) -> Optional[str]:
        if "/" in one.file:
            return one.file
        argument = re.match(r"[a-z_]+", one.file)
        return f"{name}, {one.file}" if argument and argument[0] in _ARGUMENTS else name

    def words(text: str) -> str:
        return re.sub(r"--([a-z][a-z-]*)", lambda found: found[1].replace("-", "_"), text)

    try:
        yield
    except InputError as error:
        raise relocated(error, place_of, words)


class DrawnResult:
    """A result that has a picture. It may be copied and stored, but for the compiled part, which draws it."""

    _core: Any = None

    def __getstate__(self) -> Dict[str, Any]:
        return {**self.__dict__, "_core": None}

    def __setstate__(self, state: Dict[str, Any]) -> None:
        self.__dict__.update(state)

    def _drawn(self) -> Any:
        if self._core is None:
            raise OrderError("what draws a result is not kept in copies of it", "draw the result that was computed")
        return self._core.figure()

    def figure(self) -> Any:
        """The data that `plot` draws: panels with series of points, labels and texts. Raises InputError where there is
        nothing to draw."""
        from ._plot import Figure

        return Figure(self._drawn())

    def plot(self, *, axes: Any = None) -> Any:
        """Draws it with matplotlib as the program does, and returns the axes. axes: where to draw. Raises InputError
        where there is nothing to draw."""
        from ._plot import draw

        return draw(self._drawn(), axes)

    def _tables(self) -> List[Table]:
        return []

    def _repr_html_(self) -> str:
        from ._plot import small_picture

        return small_picture(self._drawn, repr(self)) + "".join(one._repr_html_() for one in self._tables())
