"""How a special point depends on the other parameters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Dict, List, NamedTuple, Optional, Tuple

from ._analysis import DrawnResult, called
from . import _arguments as checked
from ._attributes import Fixed
from ._errors import InputError, OrderError
from ._table import Table


class LocatedSolution(NamedTuple):
    """A point at other values of the parameters: the value of its parameter (None: not found), whether the model would
    follow its orbit, and otherwise the problem."""

    value: Optional[float]
    admissible: bool
    problem: str


class Tolerance(Fixed, DrawnResult):
    """How a special point depends on the other parameters, as `graze tolerance` tells it.

    `parameter`, `unit` and `value` say what follows from the others. `derivatives` is the table of all others with the
    exact derivatives (and, after `vary`, what each contributes); `tolerance["delta"]` is one derivative.
    `tolerance(delta=0.61)` solves for the point at other values.
    After `vary`: `statistics`, a table of numbers over the devices, with limits of confidence (`confidence`) and
    meanings; each is an attribute too (`tolerance.mean`, `tolerance.within`), and `interval("mean")` its limits.
    `devices` is a table of each device: its value (NaN if not found), that by the derivatives, and the outcome
    ("found", "inadmissible", "failed"); `problems` counts why devices were not found. Otherwise these are None.
    """

    derivatives: Table
    parameter: str
    unit: str
    value: float
    statistics: Optional[Table]
    devices: Optional[Table]
    problems: Optional[Dict[str, int]]
    seed: Optional[int]
    confidence: Optional[float]

    def __init__(self, core: Any, seed: Optional[int]) -> None:
        self._core = core
        self.parameter = core.name
        self.unit = core.unit
        self.value = core.value
        self.derivatives = Table(*core.derivatives())
        self.statistics = None
        self.devices = None
        self.problems = None
        self.seed = None
        self.confidence = None
        self._statistics: Dict[str, Tuple[float, float, float]] = {}
        if core.has_yield:
            self.statistics = Table(*core.statistics())
            devices = core.devices()
            self.devices = Table(devices, devices.values(), [core.unit, core.unit, ""])
            self.problems, self.seed, self.confidence = dict(core.problems), seed, core.confidence
            columns = [self.statistics[name] for name in ("value", "low", "high")]
            self._statistics = dict(zip(self.statistics["quantity"], zip(*(column.tolist() for column in columns))))

    def __getitem__(self, name: str) -> float:
        names = self.derivatives["parameter"]
        if name not in names:
            raise KeyError(f"{self.parameter} has no derivative by {name!r}; it has those by {', '.join(names)}")
        return float(self.derivatives[f"d{self.parameter}"][names.index(name)])

    def __getattr__(self, name: str) -> float:
        if name.startswith("_"):
            raise AttributeError(name)
        if name not in self._statistics:
            known = ", ".join(self._statistics)
            raise AttributeError(f"there is no statistic {name!r}" + (f"; there are {known}" if known else ""))
        return self._statistics[name][0]

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self._statistics]

    def interval(self, name: str) -> Tuple[float, float]:
        """The limits of confidence of a statistic, NaN if it has none. Raises InputError for another name."""
        if name not in self._statistics:
            raise InputError(f"there is no statistic {name!r}", ", ".join(self._statistics) or "give vary to tolerance()")
        _, low, high = self._statistics[name]
        return low, high

    def __call__(self, **values: float) -> LocatedSolution:
        """Solves for the point at other values of other parameters, from the known one, by Newton's method. Raises
        InputError for a name that is no such parameter."""
        if self._core is None:
            raise OrderError("what solves for other values is not kept in copies", "ask the point again")
        with called("tolerance()"):
            made = self._core.solve([(name, checked.number(value, name)) for name, value in values.items()])
        return LocatedSolution(made["value"], made["admissible"], made["problem"])

    def _drawn(self) -> Any:
        if self._core is not None and not self._core.has_yield:
            raise InputError("without tolerances all devices are alike", 'say what differs: vary={"name": "1%"}')
        return super()._drawn()

    def plot(self, *, axes: Any = None) -> Any:
        """Draws the distribution of the devices, beside the normal one by the derivatives alone, and returns the axes.
        Raises InputError without devices."""
        return super().plot(axes=axes)

    def _tables(self) -> List[Table]:
        return [self.derivatives, *([self.statistics] if self.statistics is not None else [])]

    def to_pandas(self) -> Any:
        """The derivatives as a pandas DataFrame."""
        return self.derivatives.to_pandas()

    def __repr__(self) -> str:
        devices = f", over {len(self.devices)} devices" if self.devices is not None else ""
        unit = f" {self.unit}" if self.unit else ""
        return (f"<Tolerance of {self.parameter} = {self.value:.9g}{unit}: "
                f"{len(self.derivatives)} derivatives{devices}>")


def tolerance_texts(vary: Any) -> List[str]:
    if not isinstance(vary, Mapping) or not vary:
        raise checked.wrong(vary, "vary", "is no dict of sizes", 'give a dict, as {"delta": "1%", "zeta": (0.002, "uniform")}')
    texts = []
    for name, size in vary.items():
        spread = ""
        if isinstance(size, (tuple, list)):
            if len(size) != 2:
                raise checked.wrong(size, "vary", "is no size", 'give a size, or a size and "uniform" or "normal"')
            size, spread = size[0], f":{checked.text(size[1], 'vary')}"
        texts.append(f"{checked.text(str(name), 'vary')}={checked.expression(size, 'vary')}{spread}")
    return texts


def interval_text(within: Any) -> str:
    if within is None or isinstance(within, str):
        return checked.text(within or "", "within")
    if not isinstance(within, (tuple, list)) or len(within) != 2:
        raise checked.wrong(within, "within", "is no interval", "give (low, high), of which one may be None")
    low, high = ("" if one is None else checked.expression(one, "within") for one in within)
    return f"{low}:{high}"
