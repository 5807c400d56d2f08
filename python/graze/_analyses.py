"""What follows from one point of a branch: what a grazing leads to, how long a trip takes, how the point depends on
other parameters, where a ladder of grazings ends, and what certifies the orbit."""

from __future__ import annotations

import html
import re
import warnings
from collections.abc import Mapping
from contextlib import contextmanager
from typing import (Any, Callable, Dict, Iterable, Iterator, List, NamedTuple, NoReturn, Optional, Sequence, Tuple,
                    Union)

from . import _graze
from ._errors import InputError, Interrupted, OrderError
from ._progress import Progress, told_to
from ._table import Table


# Arguments


@contextmanager
def _called(name: str) -> Iterator[None]:
    """Errors inside get the name of the function and of the argument as their place."""
    try:
        yield
    except InputError as error:
        for one in error.all:
            known = re.match(r"[a-z_]+", one.file) if "/" not in one.file else None
            argument = one.file if known and known[0] in _ARGUMENTS else ""
            if "/" not in one.file:
                one.file = f"{name}, {argument}" if argument and argument != "point" else name
            one.line = one.column = 0
            for attribute in ("problem", "remedy"):
                told = re.sub(r"--([a-z][a-z-]*)", lambda found: found[1].replace("-", "_"), getattr(one, attribute))
                setattr(one, attribute, told)
        raise


_ARGUMENTS = {"point", "parameter", "until", "greatest_speed", "overshoot", "disturbance", "beside", "ramp", "wave",
              "wave_period", "noise", "memory", "at", "vary", "within", "devices", "seed", "rungs", "quantities", "run",
              "type", "cycles", "motions", "samples", "verify", "all"}


def _wrong(name: str, value: Any, remedy: str) -> InputError:
    return InputError(f"{name} is {value!r}", remedy, name)


def _number(name: str, value: Any) -> float:
    try:
        if isinstance(value, (bool, str, bytes)):
            raise TypeError
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise _wrong(name, value, "give a number") from None


def _positive(name: str, value: Any) -> float:
    number = _number(name, value)
    if not 0 < number < float("inf"):
        raise _wrong(name, value, "give a positive number")
    return number


def _whole(name: str, value: Any, least: int = 1) -> int:
    try:
        if isinstance(value, bool):
            raise TypeError
        number = value.__index__()
    except (AttributeError, TypeError):
        raise _wrong(name, value, f"give a whole number from {least} on") from None
    if not least <= number < 2**53:
        raise _wrong(name, value, f"give a whole number from {least} on" if number < least else "give a smaller number")
    return int(number)


def _truth(name: str, value: Any) -> bool:
    try:
        if value == 0 or value == 1:
            return bool(value)
    except ValueError:
        pass
    raise _wrong(name, value, "give True or False")


def _text(name: str, value: Any) -> str:
    """A number, or an expression in the parameters, as text that the library reads."""
    if isinstance(value, (str, _graze.Expression)):
        text = str(value)
        if not text.strip():
            raise _wrong(name, value, "give a number")
        return text
    return repr(_number(name, value))


def _texts(name: str, values: Any) -> List[str]:
    """One number, several, or a text of several, in which FIRST:LAST stands for one number in each decade."""
    if isinstance(values, str):
        values = [part for part in (one.strip() for one in values.split(",")) if part]
    elif isinstance(values, Mapping) or not hasattr(values, "__iter__"):
        values = [values]
    return [_text(name, one) for one in values]


def _name(name: str, value: Any) -> str:
    """A name that may be left out."""
    if value is None:
        return ""
    if not isinstance(value, (str, _graze.Expression)) or not str(value):
        raise _wrong(name, value, "give a name")
    return str(value)


def _end(until: Any) -> Optional[str]:
    if until is None or isinstance(until, str):
        return until
    if not isinstance(until, (tuple, list)) or len(until) != 2:
        raise _wrong("until", until, 'give "q=0.9", ("q", 0.9) or "end"')
    return f"{until[0]}={_text('until', until[1])}"


def _disturbance(given: Any) -> List[Tuple[str, str]]:
    if given is None:
        return []
    if not isinstance(given, Mapping):
        raise _wrong("disturbance", given, 'give a dict, as {"x": 0.01}')
    return [(str(name), _text("disturbance", value)) for name, value in given.items()]


def _tolerances(vary: Any) -> List[str]:
    if not isinstance(vary, Mapping) or not vary:
        raise _wrong("vary", vary, 'give a dict, as {"delta": "1%", "zeta": (0.002, "uniform")}')
    texts = []
    for name, size in vary.items():
        spread = ""
        if isinstance(size, (tuple, list)):
            if len(size) != 2:
                raise _wrong("vary", vary, 'give a size, or a size and "uniform" or "normal"')
            size, spread = size[0], f":{size[1]}"
        texts.append(f"{name}={_text('vary', size)}{spread}")
    return texts


def _interval(within: Any) -> str:
    if within is None or isinstance(within, str):
        return within or ""
    if not isinstance(within, (tuple, list)) or len(within) != 2:
        raise _wrong("within", within, "give (low, high), of which one may be None")
    low, high = ("" if one is None else _text("within", one) for one in within)
    return f"{low}:{high}"


# Results


class _Result:
    """What results have in common: they may be copied and stored, but not what draws them."""

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


class CycleMap:
    """The map of a cycle from touch to touch, to leading order: with x the differences of the active states from the
    orbit without contact, of which C is the clearance,

        x -> P (x + B s),   s = sqrt(-2 a h) where h = C + g x is negative, and 0 elsewhere

    (or B (-h)^(3/2) or B (-h) in place of B s, as `order` says).

    Attributes: `order` ("square-root", "three-halves", "linear"); `active`, the names of the active states; `matrix`
    (P), `impact` (B), `gradient` (g), `acceleration` (a), `restitution`; `scales` of the active states; `state`, all
    states at the touch; `multipliers`, the largest first; `clearance_rate`, the derivative of C by the parameter (or
    None), and `steady`, that of x; `time` of a cycle, `half` whether it is half an orbit.
    """

    def __init__(self, core: Any, active: List[str]) -> None:
        self._core, self.active = core, tuple(active)
        self.order: str = core.order
        self.matrix, self.impact, self.gradient = core.matrix, core.impact, core.gradient
        self.acceleration, self.restitution = core.acceleration, core.restitution
        self.scales, self.state, self.steady = core.scales, core.state, core.steady
        self.multipliers = core.multipliers
        self.clearance_rate: Optional[float] = core.clearance_rate
        self.time: float = core.time
        self.half: bool = core.half

    def __getstate__(self) -> NoReturn:
        raise OrderError("a map cannot be copied or stored", "ask the point for it again: point.grazing().cycle_map")

    def projections(self, count: int) -> Any:
        """The effect of a contact on the clearance 1, 2, ..., count cycles later, per unit of its approach speed:
        g P^k B."""
        return self._core.projections(_whole("count", count))

    def image(self, state: Iterable[float], clearance: float) -> Any:
        """The active states after one cycle, with the next order where it is known. Raises InputError for a wrong number
        of states."""
        return self._core.image([_number("state", one) for one in state], _number("clearance", clearance))

    def motion(self, clearance: float, *, transient: int = 2000, cycles: int = 2000) -> "MapMotion":
        """What the map settles on at a negative clearance of the orbit without contact, after so many cycles of
        transient, examined for so many `cycles`."""
        clearance, transient = _number("clearance", clearance), _whole("transient", transient, 0)
        return MapMotion(*self._core.motion(clearance, transient, _whole("cycles", cycles)))

    def __repr__(self) -> str:
        return f"<CycleMap ({self.order}) of {', '.join(self.active)}>"


class MapMotion(NamedTuple):
    """What the map of a cycle settles on."""

    period: int  #: in cycles; 0: it does not repeat
    contacts: int  #: in one period, or in all cycles that were examined
    largest: float  #: largest approach speed; of a compliant contact largest depth
    bounded: bool


class Grazing(_Result, Mapping):  # type: ignore[type-arg]
    """What an orbit that touches leads to, as `graze grazing` tells it.

    A mapping from names of facts to their values: `grazing["verdict"]`, or `grazing.verdict`, is "lost", "persists",
    "folds" or "undecided" (`reason` says why). `facts` is the table of all, with their meanings: the acceleration, the
    restitution, the projections, growth of contacts, ... Facts that do not apply are not in it.
    `projections` is an array of the facts projection_1, projection_2, ...; `cycle_map` the map itself (None where there
    is none); `trial_motions` the table of the motions simulated to check the verdict (empty without `verify`).
    """

    def __init__(self, point: str, made: Dict[str, Any]) -> None:
        import numpy

        self.point = point
        self.facts, self.reason = Table(*made["facts"]), made["reason"]
        self.trial_motions = Table(*made["trial_motions"])
        self._values = dict(zip(self.facts["quantity"], self.facts["value"]))
        names = [name for name in self._values if re.fullmatch(r"projection_\d+", name)]
        self.projections = numpy.array([self._values[name] for name in names], dtype=float)
        self.cycle_map = CycleMap(made["map"], made["active"]) if made["map"].exists else None

    def __getstate__(self) -> Dict[str, Any]:
        return {**super().__getstate__(), "cycle_map": None}

    def __getitem__(self, name: str) -> Any:
        try:
            return self._values[name]
        except KeyError:
            raise KeyError(f"there is no fact {name!r}; there are {', '.join(self._values)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._values[name]
        except KeyError:
            raise AttributeError(f"no fact {name!r} applies to this touch; there are {', '.join(self._values)}") from None

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self._values]

    def figure(self) -> NoReturn:
        """Raises InputError: a verdict has no picture."""
        raise InputError("a verdict has no picture", "plot the orbit (point.plot()), or trips (point.trip().plot())")

    def plot(self, *, axes: Any = None) -> NoReturn:
        """Raises InputError: a verdict has no picture. `point.trip()` has one."""
        self.figure()

    def to_pandas(self) -> Any:
        """The facts as a pandas DataFrame."""
        return self.facts.to_pandas()

    def __repr__(self) -> str:
        more = f" ({self.reason})" if self.reason else ""
        return f"<Grazing at {self.point}: {self._values.get('verdict', 'no verdict')}{more}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self.facts._repr_html_()}"


class Trips(_Result):
    """How long trips take, as `graze trip` tells it.

    `table` has a row for each overshoot, rate, amplitude or level of noise, and the columns of `graze trip`;
    `trips["end_time"]` is one of them. Numbers of trips that have not come to their end are NaN, and `unfinished` has
    messages about those. `parameter` is what is moved, `unit` its unit, `value` its value at the point, `side` (1 above,
    -1 below) where the motion is lost; `kind` is "touch" or "fold"; `cycle` the time of a cycle; `end`, in words, what
    ends the trips; `speed` the approach speed up to which the map of a touch is used; `coefficient` and `rate` those of
    the normal form of a fold (a and b).
    `wanted` is how many rows were asked for; fewer are there after an interruption.
    """

    def __init__(self, core: Any, about: Dict[str, Any]) -> None:
        self._core = core
        self.parameter: str = about["parameter"]
        self.unit: str = about["unit"]
        self.kind: str = about["kind"]
        self.end: str = about["end"]
        self.value: float = about["value"]
        self.cycle: float = about["cycle"]
        self.side: int = about["side"]
        self.speed: Optional[float] = about["speed"]
        self.coefficient: Optional[float] = about["coefficient"]
        self.rate: Optional[float] = about["rate"]
        self.table = Table(*core.table())
        self.unfinished: List[str] = core.unfinished()
        self.wanted: int = core.wanted

    def __getitem__(self, name: str) -> Any:
        return self.table[name]

    def __len__(self) -> int:
        return len(self.table)

    def _tables(self) -> List[Table]:
        return [self.table]

    def to_pandas(self) -> Any:
        """The table as a pandas DataFrame."""
        return self.table.to_pandas()

    def __repr__(self) -> str:
        first = next(iter(self.table))
        unfinished = f", {len(self.unfinished)} unfinished" if self.unfinished else ""
        return (f"<Trips from the {self.kind} at {self.parameter} = {self.value:.9g} to {self.end}: "
                f"{len(self)} by {first}{unfinished}>")


class LocatedSolution(NamedTuple):
    """A point at other values of the parameters: the value of its parameter (None: not found), whether the model would
    follow its orbit, and otherwise the problem."""

    value: Optional[float]
    admissible: bool
    problem: str


class Tolerance(_Result):
    """How a special point depends on the other parameters, as `graze tolerance` tells it.

    `parameter`, `unit` and `value` say what follows from the others. `derivatives` is the table of all others with the
    exact derivatives (and, after `vary`, what each contributes); `tolerance["delta"]` is one derivative.
    `tolerance(delta=0.61)` solves for the point at other values.
    After `vary`: `statistics`, a table of numbers over the devices, with limits of confidence (`confidence`) and
    meanings; each is an attribute too (`tolerance.mean`, `tolerance.within`), and `interval("mean")` its limits.
    `devices` is a table of each device: its value (NaN if not found), that by the derivatives, and the outcome
    ("found", "inadmissible", "failed"); `problems` counts why devices were not found. Otherwise these are None.
    """

    def __init__(self, core: Any, seed: Optional[int]) -> None:
        self._core = core
        self.parameter: str = core.name
        self.unit: str = core.unit
        self.value: float = core.value
        self.derivatives = Table(*core.derivatives())
        self.statistics: Optional[Table] = None
        self.devices: Optional[Table] = None
        self.problems: Optional[Dict[str, int]] = None
        self.seed: Optional[int] = None
        self.confidence: Optional[float] = None
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
        with _called("tolerance()"):
            made = self._core.solve([(name, _number(name, value)) for name, value in values.items()])
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


class Chatter(_Result):
    """A ladder of grazings, each with one contact more, and the onset of chatter to which it leads, as `graze ladder`
    tells it.

    `table`: the grazings, with the value of `parameter`, the ratio `lambda` of successive distances, and the first flip
    and fold of the branch that leaves each. `limit` and `limit_error`: the onset of chatter from the motion itself;
    `extrapolated` and `extrapolated_error`: from the grazings alone; `ratio`: to which `lambda` goes; `restitution` at
    the limit. They are None where there is none, and `no_limit` says why. `ends`: why there are no further grazings.
    """

    def __init__(self, made: Dict[str, Any]) -> None:
        self.table = Table(*made["table"])
        self.parameter: str = made["parameter"]
        self.ends: str = made["ends"]
        self.no_limit: str = made["no_limit"]
        self.limit: Optional[float] = made["limit"]
        self.limit_error: Optional[float] = made["limit_error"]
        self.extrapolated: Optional[float] = made["extrapolated"]
        self.extrapolated_error: Optional[float] = made["extrapolated_error"]
        self.restitution: Optional[float] = made["restitution"]
        self.ratio: Optional[float] = made["ratio"]

    def __getitem__(self, name: str) -> Any:
        return self.table[name]

    def __len__(self) -> int:
        return len(self.table)

    def figure(self) -> NoReturn:
        """Raises InputError: `point.ladder()` is the run whose orbits can be drawn."""
        raise InputError("this ladder has no picture", "plot the run of the same ladder: point.ladder().plot()")

    def plot(self, *, axes: Any = None) -> NoReturn:
        """Raises InputError: `point.ladder()` is the run whose orbits can be drawn."""
        self.figure()

    def to_pandas(self) -> Any:
        """The table as a pandas DataFrame."""
        return self.table.to_pandas()

    def __repr__(self) -> str:
        limit = f"{self.parameter} = {self.limit:.12g} +- {self.limit_error:.1g}" if self.limit is not None else "no limit"
        return f"<Chatter: {len(self)} grazing{'s' * (len(self) != 1)}, {limit}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self.table._repr_html_()}"


class Certificate:
    """What certifies that the model would follow an orbit (`graze orbit --format json`).

    `signature`; `symmetry` (of a half orbit; otherwise empty); `admissible`, and `reason` why not. Tables, in which
    segments count from 1: `segments` (how the event of each is met at its end), `minima` (of event functions inside
    segments: how close other events come), `end_values` (of other event functions at the ends).
    """

    def __init__(self, made: Dict[str, Any]) -> None:
        self.signature: str = made["signature"]
        self.symmetry: str = made["symmetry"]
        self.admissible: bool = made["admissible"]
        self.reason: str = made["reason"]
        self.segments = _counted(*made["segments"])
        self.minima = _counted(*made["minima"])
        self.end_values = _counted(*made["end_values"])

    def __repr__(self) -> str:
        return f"<Certificate of {self.signature}: {'admissible' if self.admissible else self.reason or 'inadmissible'}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self.segments._repr_html_()}"


def _counted(names: Sequence[str], columns: Sequence[Any], units: Sequence[str]) -> Table:
    """A table whose segments are whole numbers."""
    return Table(names, [column.astype(int) if name == "segment" else column for name, column in zip(names, columns)],
                 units)


# Points

_Work = Callable[[Any], Any]  # makes the compiled part of trips from the point at which they begin


class PointAnalyses:
    """What can be asked of a point of a branch; `Point` has all of it."""

    _run: Any
    label: str
    number: int

    def _named(self) -> str:
        return f"{self._run.name}:{self.label or self.number}"

    def _own_file(self) -> Any:
        """The results by a connection of their own, so that others can read them while something is computed."""
        return _graze.ResultFile(self._run._store.path, write=False)

    def grazing(self, *, parameter: Optional[str] = None, verify: bool = False) -> Grazing:
        """Whether an attractor survives this grazing or is lost, and how contacts grow beyond it.

        parameter: what moves the orbit through the grazing (the parameter of its run).
        verify: check the verdict by simulation near the grazing (`grazing.trial`).

        Raises InputError where the orbit does not touch.
        """
        with _called("grazing()"):
            name = _name("parameter", parameter)
            try:
                made = _graze.grazing(self._own_file(), self._named(), parameter=name, verify=_truth("verify", verify))
            except KeyboardInterrupt:
                raise Interrupted() from None
        return Grazing(self._named(), made)

    def trip(self, *, overshoot: Any = None, parameter: Optional[str] = None, beside: Optional[PointAnalyses] = None,
             disturbance: Optional[Mapping[str, Any]] = None, until: Any = None, greatest_speed: Optional[float] = None,
             cycles: Optional[int] = None, ramp: Any = None, wave: Any = None, wave_period: Optional[float] = None,
             noise: Any = None, memory: Optional[float] = None, at: Any = None, motions: Optional[int] = None,
             seed: Optional[int] = None, threads: Optional[int] = None, progress: Progress = None) -> Trips:
        """How long a motion takes to be lost beyond this grazing (with the verdict "lost") or fold.

        The parameter is moved beyond the point at once, by each overshoot; or it changes in time:
        overshoot: signed distances beyond the point: a number, several, or a text in which "1e-2:1e-20" stands for one in
            each decade (that, times the size of the parameter, if nothing else is asked for).
        ramp: rates per unit of time, for a linear rise or fall.
        wave: amplitudes of an oscillation about `at`; wave_period: its period in cycles of the orbit (100).
        noise: standard deviations of a noise about `at` that is constant in each cycle; memory: its correlation time in
            cycles (0); motions: how many are simulated at each level (1000); seed (1).
        at: the value of the parameter that is disturbed, before the point; for a ramp, its first value.

        until: what ends trips: "q=0.9" or ("q", 0.9), where an expression reaches a level, or "end", where the motion
            itself ends. greatest_speed: the first contact with this approach speed. Otherwise the limit of the map, or
            the passage of the fold.
        cycles: the largest number of simulated cycles (2000; 100 under noise).
        disturbance: of the initial state, a dict by name. parameter: what is moved (the parameter of the run).
        beside: another point, to compare overshoots of the same size.
        threads: for noise (all cores); results do not depend on it. progress: see `graze.sweep`.

        Raises InputError for arguments that contradict each other, and where the motion is not lost at the point;
        Interrupted, whose `run` has the finished rows.
        """
        with _called("trip()"):
            _check_together(overshoot=overshoot, disturbance=disturbance, beside=beside, ramp=ramp, wave=wave,
                            wave_period=wave_period, noise=noise, memory=memory, at=at, motions=motions, seed=seed,
                            until=until, greatest_speed=greatest_speed)
            if beside is not None and not isinstance(beside, PointAnalyses):
                raise _wrong("beside", beside, "give another point")
            asked = _AskedTrips(parameter, until, greatest_speed, at, cycles)
            if ramp is not None:
                work = asked.ramp(ramp)
            elif wave is not None:
                work = asked.wave(wave, wave_period)
            elif noise is not None:
                work = asked.noise(noise, memory, motions, seed, threads)
            else:
                work = asked.beyond(overshoot, beside, disturbance)
            return asked.computed(self, work, progress)

    def tolerance(self, *, parameter: Optional[str] = None, vary: Optional[Mapping[str, Any]] = None, within: Any = None,
                  devices: int = 10_000, seed: int = 1, threads: Optional[int] = None,
                  progress: Progress = None) -> Tolerance:
        """How the value of the parameter at which this point lies depends on all other parameters: exact derivatives, and
        with `vary` the statistics over devices that differ, each solved for by Newton's method.

        parameter: whose value follows from the others (the parameter of the run).
        vary: a dict of the parameters that differ: a number is a standard deviation, "1%" one relative to the value,
            (0.01, "uniform") or ("1%", "uniform") the half width of a uniform distribution.
        within: (low, high), acceptable values, of which the yield is computed; one of them may be None.
        devices, seed: how many devices are drawn at random. threads: all cores; results do not depend on it.
        progress: see `graze.sweep`.

        Raises InputError for a point whose value does not follow from other parameters; Interrupted, whose `run` has the
        devices that were made.
        """
        from ._runs import _threads

        with _called("tolerance()"):
            if vary is None and within is not None:
                raise InputError("without tolerances all devices are alike", 'say what differs: vary={"name": "1%"}',
                                 "within")
            name = _name("parameter", parameter)
            tolerances = None if vary is None else _tolerances(vary)
            interval = _interval(within)
            devices, seed, threads = _whole("devices", devices), _whole("seed", seed, 0), _threads(threads)
            told, close = told_to(progress, "point")
            core = None
            try:
                core = _graze.LocatedPoint(self._own_file(), self._named(), name)
                if tolerances is not None:
                    core.make_devices(tolerances, within=interval, devices=devices, seed=seed, threads=threads, told=told)
            except KeyboardInterrupt:
                raise Interrupted(Tolerance(core, seed) if core and core.has_yield else None) from None
            finally:
                close()
        return Tolerance(core, seed)

    def chatter(self, *, parameter: Optional[str] = None, rungs: int = 8, progress: Progress = None) -> Chatter:
        """The ladder of grazings that begins at this one, and the onset of chatter to which it leads, from the motion
        and from the grazings alone. `ladder` computes the same grazings as a run, with their orbits.

        rungs: the largest number of grazings, this one included. parameter: what varies (the parameter of the run).
        progress: see `graze.sweep`.

        Raises InputError where no ladder begins; Interrupted, whose `run` has the grazings that were reached.
        """
        with _called("chatter()"):
            core = _graze.LadderOfGrazings(self._named(), _name("parameter", parameter), _whole("rungs", rungs))
            told, close = told_to(progress, "point")
            try:
                core.climb(self._own_file(), told)
            except KeyboardInterrupt:
                raise Interrupted(Chatter(core.object()) if core.has_grazings else None) from None
            finally:
                close()
        return Chatter(core.object())

    def motion(self, samples: int = 500, *, quantities: Any = ()) -> Table:
        """The motion along one whole period, segment by segment, with both sides of every jump.

        samples: about how many rows. quantities: names or expressions, for further columns.
        Columns: the time `t`, the states, the quantities, and the `segment` (from 1), its `mode` and its `end`.

        Raises InputError for what is no quantity. Where the motion cannot be followed to the end of a segment, it warns,
        and the table has what there is.
        """
        with _called("motion()"):
            names = [quantities] if isinstance(quantities, (str, _graze.Expression)) else list(quantities)
            if not 2 <= _whole("samples", samples) <= 10_000_000:
                raise _wrong("samples", samples, "give a whole number from 2 to 10000000")
            (columns, arrays, units), problems = _graze.orbit_motion(self._own_file(), self._named(),
                                                                     [str(one) for one in names], int(samples))
        for problem in problems:
            warnings.warn(problem, RuntimeWarning, stacklevel=2)
        order = [*range(3, len(columns)), 0, 1, 2]
        return _counted(*([items[one] for one in order] for items in (columns, arrays, units)))

    def certificate(self) -> Certificate:
        """What certifies that the model would follow this orbit, and how close other events come."""
        store = self._run._store
        with _called("certificate()"), store._reading:
            return Certificate(_graze.certificate(store.file, self._named()))


class _AskedTrips:
    """What trips have in common, whether the parameter is moved at once or changes in time. Arguments are checked before
    anything is computed."""

    def __init__(self, parameter: Any, until: Any, greatest_speed: Any, at: Any, cycles: Any) -> None:
        self.parameter, self.until = _name("parameter", parameter), _end(until)
        self.speed = None if greatest_speed is None else _positive("greatest_speed", greatest_speed)
        self.at = None if at is None else _text("at", at)
        self.cycles = None if cycles is None else _whole("cycles", cycles)
        self.changes = True  # the parameter, in time

    def _rest(self) -> str:
        if self.at is None:
            raise InputError("nothing says where the motion rests", "give the value that is disturbed: at", "at")
        return self.at

    def beyond(self, overshoot: Any, beside: Any, disturbance: Any) -> _Work:
        self.changes = False
        overshoots = None if overshoot is None else _texts("overshoot", overshoot)
        disturbed = _disturbance(disturbance)

        def work(point: Any) -> Any:
            other = None if beside is None else self._loss_point(beside)
            return _graze.TripsBeyond(point, beside=other, overshoots=overshoots, cycles=self.cycles or 2000,
                                      disturbance=disturbed)

        return work

    def ramp(self, rates: Any) -> _Work:
        texts = _texts("ramp", rates)
        return lambda point: _graze.RampTrips(point, rates=texts, at=self.at, cycles=self.cycles or 2000)

    def wave(self, amplitudes: Any, period: Any) -> _Work:
        rest, texts = self._rest(), _texts("wave", amplitudes)
        cycles = 100.0 if period is None else _positive("wave_period", period)
        return lambda point: _graze.WaveTrips(point, amplitudes=texts, at=rest, cycles=self.cycles or 2000, period=cycles)

    def noise(self, levels: Any, memory: Any, motions: Any, seed: Any, threads: Any) -> _Work:
        from ._runs import _threads

        rest, texts, jobs = self._rest(), _texts("noise", levels), _threads(threads)
        correlated = 0.0 if memory is None else _number("memory", memory)
        number = 1000 if motions is None else _whole("motions", motions)
        first = 1 if seed is None else _whole("seed", seed, 0)
        return lambda point: _graze.NoiseTrips(point, levels=texts, at=rest, cycles=self.cycles or 100,
                                               memory=correlated, motions=number, seed=first, threads=jobs)

    def _loss_point(self, point: PointAnalyses) -> Any:
        return _graze.LossPoint(point._own_file(), point._named(), parameter=self.parameter, until=self.until,
                                greatest_speed=self.speed)

    def computed(self, of: PointAnalyses, work: _Work, progress: Progress) -> Trips:
        told, close = told_to(progress, "point")
        core, about = None, {}
        try:
            point = self._loss_point(of)
            about = point.object()
            if self.changes and about["kind"] == "fold" and not about["end_given"]:
                raise InputError("nothing says where a motion ends that has left a fold",
                                 'give until="EXPR=LEVEL" or until="end"', "until")
            core = work(point)
            core.compute(told)
        except KeyboardInterrupt:
            raise Interrupted(Trips(core, about) if core and core.rows else None) from None
        finally:
            close()
        return Trips(core, about)


def _check_together(**given: Any) -> None:
    """Refuses arguments that have no effect together."""
    asked = {name for name, value in given.items() if value is not None}
    changing = [name for name in ("ramp", "wave", "noise") if name in asked]
    if len(changing) > 1:
        raise InputError(f"{' and '.join(changing)} are not done at the same time", "choose one of them", changing[0])
    if {"until", "greatest_speed"} <= asked:
        raise InputError("until and greatest_speed both say what ends trips", "give one of them", "until")
    if changing:
        for name in ("overshoot", "disturbance", "beside"):
            if name in asked:
                raise InputError(f"{name} has no effect where the parameter changes in time", "leave it out", name)
    for name, needed in (("at", ("ramp", "wave", "noise")), ("wave_period", ("wave",)), ("memory", ("noise",)),
                         ("motions", ("noise",)), ("seed", ("noise",))):
        if name in asked and not asked.intersection(needed):
            raise InputError(f"{name} has no effect without {' or '.join(needed)}", "leave it out, or give one of them",
                             name)


def points(results: Any, *, run: Union[str, Sequence[str]] = (), type: Union[str, Sequence[str]] = (),
           all: bool = False) -> Table:
    """The special points of branches, with all columns of `graze points --format csv`.

    results: a run, or all results that were read (`read_results`, `run_study`).
    run: names of runs, of several (all branches). type: types, as "GR" or ("GR", "SN") (all special ones).
    all: regular points too.

    Raises InputError where there are no branches, and for types that do not exist.
    """
    if not hasattr(results, "_store"):
        raise TypeError(f"points() needs a run or the results of a study, not {results.__class__.__name__}")
    with _called("points()"), results._store._reading:
        runs, types = ([one] if isinstance(one, str) else [str(item) for item in one] for one in (run, type))
        if not runs and hasattr(results, "_record"):
            runs = [results.name]
        return Table(*_graze.listed_points(results._store.file, runs=runs, types=[one.upper() for one in types],
                                           all=_truth("all", all)))
