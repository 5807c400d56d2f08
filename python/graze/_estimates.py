"""Parameters estimated from records by themselves, without a model."""

from __future__ import annotations

import html
from collections.abc import Mapping
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Tuple

from . import _arguments as checked, _graze
from ._errors import InputError, OrderError
from ._record import MeasuredRecord, MeasuredRecords, read_record
from ._record_arguments import table_words
from ._table import Table


class Estimate(NamedTuple):
    """An estimated number: `value`, `unit`, its standard `error` (NaN: unknown), the ends `low` and `high` of the interval
    that covers the truth with a probability of 95 %, and the degrees of `freedom` of the error."""

    value: float
    error: float
    low: float
    high: float
    freedom: float
    unit: str


class Estimates(Mapping):  # type: ignore[type-arg]
    """Numbers estimated from records: a mapping from names to `Estimate`.

    `warnings` says why intervals cannot be relied on: an interval has a meaning only where the list is empty.
    `covariance` is the matrix of covariances in the order of the names, zero where unknown (None: all are unknown);
    `table` has all as columns; `plot()` draws measured and fitted values, and the residuals.
    """

    def __init__(self, made: Any) -> None:
        values, self.covariance, told, self._figure = made
        nan = float("nan")
        self._values: Dict[str, Estimate] = {}
        for name, unit, value, error, freedom, width in values:
            known = freedom > 0
            self._values[name] = Estimate(value, error if known else nan, value - width if known else nan,
                                          value + width if known else nan, freedom if known else nan, unit)
        self.warnings: List[str] = list(told)

    def __getstate__(self) -> Dict[str, Any]:
        return {**vars(self), "_figure": None}

    def __getitem__(self, name: str) -> Estimate:
        if name not in self._values:
            raise KeyError(f"there is no estimate {name!r}; there are {', '.join(self._values)}")
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    @property
    def table(self) -> Table:
        """All estimates: name, unit, value, error, low, high, freedom."""
        import numpy

        names = ("value", "error", "low", "high", "freedom")
        columns = [numpy.array([getattr(one, name) for one in self.values()], dtype=float) for name in names]
        return Table(["name", "unit", *names], [list(self), [one.unit for one in self.values()], *columns])

    def plot(self, *, axes: Any = None) -> Any:
        """Draws measured and fitted values, and the residuals below. Returns the axes."""
        from ._plot import draw

        if self._figure is None:
            raise OrderError("what draws estimates is not kept in copies of them", "draw those that were computed")
        return draw(self._figure, axes)

    def __repr__(self) -> str:
        values = ", ".join(f"{name} {one.value:.6g}" + (f" +- {one.error:.2g}" if one.error == one.error else "")
                           for name, one in self.items())
        return f"<Estimates: {values}{f'; warnings: {len(self.warnings)}' if self.warnings else ''}>"

    def _repr_html_(self) -> str:
        told = "".join(f"<p>{html.escape(text)}</p>" for text in self.warnings)
        return str(self.table._repr_html_()) + told


def _estimates(what: str, records: Tuple[Any, ...], words: Dict[str, Any]) -> Estimates:
    found: List[MeasuredRecord] = []
    for one in records:
        several = one if isinstance(one, (MeasuredRecords, list, tuple)) else [one]
        found += [each if isinstance(each, MeasuredRecord) else read_record(each) for each in several]
    if not found:
        raise InputError("there are no records", "give one or more")
    return Estimates(MeasuredRecords(found)._computed(_graze.identified, [one._core for one in found], what, words))


def _known(value: Any, name: str, words: Dict[str, Any], above: Optional[float] = None) -> None:
    """A number that is known, or (number, standard error), or an Estimate."""
    if value is None:
        return
    error: Any = 0.0
    if isinstance(value, Estimate):
        value, error = value.value, value.error
    elif isinstance(value, (tuple, list)):
        if len(value) != 2:
            raise InputError(f"{name} has {len(value)} items", "give a number, or (number, standard error)")
        value, error = value
    words[name] = repr(checked.number(value, name, above=above))
    words[f"{name}_error"] = checked.number(error, f"the error of {name}", least=0)


def decrement(*records: Any, channel: str = "v", peaks: int = 10) -> Estimates:
    """Natural frequency and damping ratio from free decaying oscillations, one release a record.

    records: MeasuredRecord objects or paths. channel: that decays. peaks: how many are used, the first of each record.
    Raises InputError for records from which they cannot be estimated.
    """
    words = {"channel": checked.text(channel, "channel"), "peaks": checked.whole(peaks, "peaks", 2, 100_000)}
    return _estimates("decrement", records, words)


def restitution(*records: Any, channel: str = "v", displacement: Optional[str] = None, window: int = 12,
                transition: int = 0, least_jump: float = 0.0) -> Estimates:
    """The coefficient of restitution from impacts in a velocity, one record for each set of conditions.

    The arguments are those of `MeasuredRecord.impacts`. Velocities are relative to the stop.
    """
    words = table_words("impacts", {"displacement": displacement, "window": window, "transition": transition,
                                     "least_jump": least_jump})
    return _estimates("restitution", records, {"channel": checked.text(channel, "channel"), **words})


def coupling(*records: Any, gap: Any, stiffness: Any, displacement: str = "q", current: str = "I",
             noise: Optional[Tuple[float, float]] = None) -> Estimates:
    """The constants beta1 and beta2 of an electromagnet from equilibria, one in each row of the records.

    gap: at rest. stiffness: the mass times the square of the natural frequency. Both are numbers in the units of the
    record, or (number, standard error). noise: of displacement and current, of which only the ratio matters.
    """
    words: Dict[str, Any] = {"displacement": checked.text(displacement, "displacement"),
                             "current": checked.text(current, "current")}
    _known(gap, "gap", words, above=0)
    _known(stiffness, "stiffness", words, above=0)
    if noise is not None:
        if not isinstance(noise, (tuple, list)) or len(noise) != 2:
            raise InputError(f"noise is {noise!r}", "give that of the displacement and that of the current")
        words["displacement_noise"] = checked.number(noise[0], "the noise of the displacement", above=0)
        words["current_noise"] = checked.number(noise[1], "the noise of the current", above=0)
    return _estimates("coupling", records, words)


def impedance(*records: Any, voltage: str = "V", current: str = "I", frequency: Optional[float] = None,
              beta1: Any = None, beta2: Any = None, gap: Any = None, clamped: Optional[float] = None) -> Estimates:
    """Resistance and inductance of a coil whose mass is clamped, under a sinusoidal voltage.

    frequency: of the voltage roughly, per unit of time (found from the record). With beta1 and beta2 (numbers, (number,
    error) or estimates of `coupling`), gap, and the displacement at which the mass is clamped, also the leakage
    inductance.
    """
    words: Dict[str, Any] = {"voltage": checked.text(voltage, "voltage"), "current": checked.text(current, "current")}
    for name, value in (("beta1", beta1), ("beta2", beta2), ("gap", gap)):
        _known(value, name, words, above=0 if name == "gap" else None)
    if clamped is not None:
        words["clamped"] = repr(checked.number(clamped, "clamped"))
    if frequency is not None:
        words["frequency"] = repr(checked.number(frequency, "frequency", above=0))
    return _estimates("impedance", records, words)
