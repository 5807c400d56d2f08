"""How long trips take beyond a grazing or a fold."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Dict, List, Optional, Tuple

from . import _arguments as checked, _graze
from ._analysis import DrawnResult
from ._attributes import Fixed
from ._errors import InputError
from ._progress import Progress, attended
from ._table import Table

if TYPE_CHECKING:
    from ._analyses import PointAnalyses


class Trips(Fixed, DrawnResult):
    """How long trips take, as `graze trip` tells it.

    `table` has a row for each overshoot, rate, amplitude or level of noise, and the columns of `graze trip`;
    `trips["end_time"]` is one of them. Numbers of trips that have not come to their end are NaN, and `unfinished` has
    messages about those. `parameter` is what is moved, `unit` its unit, `value` its value at the point, `side` (1 above,
    -1 below) where the motion is lost; `kind` is "touch" or "fold"; `cycle` the time of a cycle; `end`, in words, what
    ends the trips; `speed` the approach speed up to which the map of a touch is used; `coefficient` and `rate` those of
    the normal form of a fold (a and b).
    `wanted` is how many rows were asked for; fewer are there after an interruption.
    """

    table: Table
    parameter: str
    unit: str
    kind: str
    end: str
    value: float
    cycle: float
    side: int
    speed: Optional[float]
    coefficient: Optional[float]
    rate: Optional[float]
    unfinished: List[str]
    wanted: int

    def __init__(self, core: Any, about: Dict[str, Any]) -> None:
        self._core = core
        self.parameter = about["parameter"]
        self.unit = about["unit"]
        self.kind = about["kind"]
        self.end = about["end"]
        self.value = about["value"]
        self.cycle = about["cycle"]
        self.side = about["side"]
        self.speed = about["speed"]
        self.coefficient = about["coefficient"]
        self.rate = about["rate"]
        self.table = Table(*core.table())
        self.unfinished = core.unfinished()
        self.wanted = core.wanted

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


_Work = Callable[[Any], Any]  # makes the compiled part of trips from the point at which they begin


class AskedTrips:
    """What trips have in common, whether the parameter is moved at once or changes in time. Arguments are checked before
    anything is computed."""

    def __init__(self, parameter: Any, until: Any, greatest_speed: Any, at: Any, cycles: Any) -> None:
        self.parameter, self.until = checked.optional_name(parameter, "parameter"), _end(until)
        self.speed = None if greatest_speed is None else checked.number(greatest_speed, "greatest_speed", above=0)
        self.at = None if at is None else checked.expression(at, "at")
        self.cycles = None if cycles is None else checked.whole(cycles, "cycles")
        self.changes = True  # the parameter, in time

    def _rest(self) -> str:
        if self.at is None:
            raise InputError("nothing says where the motion rests", "give the value that is disturbed: at", "at")
        return self.at

    def beyond(self, overshoot: Any, beside: Optional[PointAnalyses], disturbance: Any) -> _Work:
        self.changes = False
        overshoots = None if overshoot is None else checked.expressions(overshoot, "overshoot")
        disturbed = _disturbance(disturbance)

        def work(point: Any) -> Any:
            other: Any = None if beside is None else self._loss_point(beside)
            return _graze.TripsBeyond(point, beside=other, overshoots=overshoots, cycles=self.cycles or 2000,
                                      disturbance=disturbed)

        return work

    def ramp(self, rates: Any) -> _Work:
        texts = checked.expressions(rates, "ramp")
        return lambda point: _graze.RampTrips(point, rates=texts, at=self.at, cycles=self.cycles or 2000)

    def wave(self, amplitudes: Any, period: Any) -> _Work:
        rest, texts = self._rest(), checked.expressions(amplitudes, "wave")
        cycles = 100.0 if period is None else checked.number(period, "wave_period", above=0)
        return lambda point: _graze.WaveTrips(point, amplitudes=texts, at=rest, cycles=self.cycles or 2000, period=cycles)

    def noise(self, levels: Any, memory: Any, motions: Any, seed: Any, threads: Any) -> _Work:
        rest, texts, jobs = self._rest(), checked.expressions(levels, "noise"), checked.number_of_threads(threads)
        correlated = 0.0 if memory is None else checked.number(memory, "memory")
        number = 1000 if motions is None else checked.whole(motions, "motions")
        first = 1 if seed is None else checked.whole(seed, "seed", 0)
        return lambda point: _graze.NoiseTrips(point, levels=texts, at=rest, cycles=self.cycles or 100,
                                               memory=correlated, motions=number, seed=first, threads=jobs)

    def _loss_point(self, point: PointAnalyses) -> Any:
        return _graze.LossPoint(point._own_file(), point._named(), parameter=self.parameter, until=self.until,
                                greatest_speed=self.speed)

    def computed(self, of: PointAnalyses, work: _Work, progress: Progress) -> Trips:
        core: Any = None
        about: Dict[str, Any] = {}
        with attended(progress, "point", lambda: Trips(core, about) if core and core.rows else None) as told:
            point = self._loss_point(of)
            about = point.object()
            if self.changes and about["kind"] == "fold" and not about["end_given"]:
                raise InputError("nothing says where a motion ends that has left a fold",
                                 'give until="EXPR=LEVEL" or until="end"', "until")
            core = work(point)
            core.compute(told)
        return Trips(core, about)


def _end(until: Any) -> Optional[str]:
    if until is None or isinstance(until, str):
        return until if until is None else checked.text(until, "until")
    if not isinstance(until, (tuple, list)) or len(until) != 2:
        raise checked.wrong(until, "until", "does not say what ends trips", 'give "q=0.9", ("q", 0.9) or "end"')
    return f"{checked.text(str(until[0]), 'until')}={checked.expression(until[1], 'until')}"


def _disturbance(given: Any) -> List[Tuple[str, str]]:
    if given is None:
        return []
    given = checked.a_dict(given, "disturbance", '{"x": 0.01}')
    return [(checked.text(str(name), "disturbance"), checked.expression(value, "disturbance"))
            for name, value in given.items()]


def check_together(**given: Any) -> None:
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
