"""One motion of a model."""

from __future__ import annotations

import math
import operator
from typing import TYPE_CHECKING, Any, Iterable, Mapping, Optional, Sequence, Tuple, Union

from . import _graze
from ._errors import InputError, Interrupted
from ._model import Model
from ._progress import Progress, told_to
from ._table import Table

if TYPE_CHECKING:
    import numpy

Value = Union[float, str, _graze.Expression]
"""A number, or an expression in parameters."""
Names = Union[str, _graze.Expression, Iterable[Union[str, _graze.Expression]]]
"""One name or expression, or several."""
State = Union[Mapping[str, float], Sequence[float], "numpy.ndarray"]
"""Initial values: by name, where the others are the model's, or of all states in their order."""

_MOST_ROWS = 10_000_000  # of samples, as in the program


class Simulation:
    """A model made ready to be simulated as often as wanted: `run` then costs some microseconds.

    sections, extrema: names of sections whose passages, and expressions whose extrema, are located.
    quantities: further columns of all tables: names of quantities of the model, or expressions.
    minima: whether the least value of each watched event function in each arc is found.
    tolerance: error of a step relative to the size of each state, 1e-16 to 1e-2. order: of the Taylor polynomials, 4 to
        32 (0: chosen by the tolerance). largest_step: in time (0: unbounded; contacts are found without it).
    step_limit: steps after which a motion ends. contacts_at_once: more events at one time end a motion.
    touch: minima of barriers below this are touches (0: 100 tolerances of their size).

    The model is copied: later changes of it have no effect. Threads may share a simulation. Raises InputError.
    """

    def __init__(self, model: Model, *, sections: Names = (), extrema: Names = (), quantities: Names = (),
                 minima: bool = False, tolerance: float = 1e-12, order: int = 0, largest_step: Value = 0.0,
                 step_limit: int = 100_000_000, contacts_at_once: int = 100, touch: float = 0.0) -> None:
        if not isinstance(model, Model):
            raise TypeError(f"a simulation needs a graze.Model, not {type(model).__name__}")
        self.model: Model = model.with_()
        step = self.model._number(largest_step, "largest_step") if _is_expression(largest_step) else largest_step
        self._settings = {
            "sections": _names(sections, "sections"), "extrema": _names(extrema, "extrema"),
            "quantities": _names(quantities, "quantities"), "minima": bool(minima),
            "tolerance": _real(tolerance, "tolerance"), "order": _count(order, "order", 0, 1000),
            "largest_step": _real(step, "largest_step"), "step_limit": _count(step_limit, "step_limit", 0, 2**63 - 1),
            "contacts_at_once": _count(contacts_at_once, "contacts_at_once", 0, 2**31 - 1),
            "touch": _real(touch, "touch")}
        self._core = _graze.Simulation(model._core, **self._settings)

    def run(self, *, time: Optional[Value] = None, periods: Optional[int] = None, contacts: Optional[int] = None,
            after: Optional[Value] = None, skip: Optional[int] = None, phase: Optional[str] = None,
            samples: Optional[int] = None, every: Optional[Value] = None, at: Any = None, derivatives: Names = (),
            dense: bool = False, events: Optional[Names] = None, set: Optional[Mapping[str, float]] = None,
            state: Optional[State] = None, from_: Optional[State] = None, mode: Optional[str] = None,
            progress: Progress = None) -> "Motion":
        """Computes one motion; the arguments are those of `simulate`. set: other values of parameters."""
        asked = {}
        if set:
            asked["set"] = [(str(name), _real(value, f"set, {name}")) for name, value in _items(set, "set")]
        if time is not None:
            asked["time"] = self._positive(time, "time", asked)
        if after is not None:
            asked["after"] = self._positive(after, "after", asked)
        if every is not None:
            asked["every"] = self._positive(every, "every", asked)
        if periods is not None:
            asked["periods"] = _count(periods, "periods", 1, 2**31 - 1)
        if contacts is not None:
            asked["contacts"] = _count(contacts, "contacts", 1, 2**31 - 1)
        if skip is not None and skip != 0:
            asked["skip"] = _count(skip, "skip", 1, 2**31 - 1)
        if phase is not None:
            asked["phase"] = _text(phase, "phase")
        if (samples is not None) + (every is not None) + (at is not None) > 1:
            raise InputError("samples, every and at contradict each other", "give one of them")
        if samples is not None:
            asked["samples"] = _count(samples, "samples", 0, _MOST_ROWS)
            if samples == 1:
                raise InputError("one sample has no distance to the next", "give 2 or more, or 0 for none", "samples")
        if at is not None:
            asked["at"] = _times(at, asked.get("time"))
        if derivatives:
            asked["derivatives"] = self._directions(derivatives)
        if dense:
            asked["dense"] = True
        if events is not None:
            asked["events"] = _names(events, "events")
        if from_ is not None:
            if state is not None:
                raise InputError("state and from_ are the same", "give one of them")
            state = from_
        if state is not None:
            asked["state"] = _state(self.model, state, asked.get("set"))
        if mode is not None:
            asked["mode"] = _text(mode, "mode")
        told, close = told_to(progress, "time")
        try:
            made = self._core.run(asked, told)
        finally:
            close()
        raised = made.raised
        if raised is None:
            return Motion(self, asked, made)
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted(Motion(self, asked, made)) from None
        raise raised

    def _positive(self, value: Value, name: str, asked: dict) -> float:
        if _is_expression(value):
            value = self._core.value_of(str(value), asked.get("set", []), name)
        number = _real(value, name)
        if not 0 < number < math.inf:
            raise InputError(f"{number} is not a positive number", "give a positive number", name)
        return number

    def _directions(self, names: Names) -> list:
        chosen = _names(names, "derivatives")
        known = [*self.model.initial, *self.model.parameters.independent]
        if chosen == ["all"]:
            return known
        for name in chosen:
            if name not in known:
                raise InputError(f"the model has no state or independent parameter {name!r}",
                                 f"it has {', '.join(known)}", "derivatives")
        return chosen

    def __repr__(self) -> str:
        return f"<Simulation of {self.model.name}>"

    def __reduce__(self) -> Tuple[Any, ...]:
        return _simulation_again, (self.model, self._settings)

    def __copy__(self) -> "Simulation":
        return self  # nothing of it changes

    def __deepcopy__(self, memo: Any) -> "Simulation":
        return self


def _simulation_again(model: Model, settings: dict) -> Simulation:
    return Simulation(model, **settings)


def simulate(model: Model, *, time: Optional[Value] = None, periods: Optional[int] = None,
             contacts: Optional[int] = None, after: Optional[Value] = None, skip: Optional[int] = None,
             phase: Optional[str] = None, samples: Optional[int] = None, every: Optional[Value] = None, at: Any = None,
             derivatives: Names = (), dense: bool = False, events: Optional[Names] = None, sections: Names = (),
             extrema: Names = (), quantities: Names = (), minima: bool = False,
             set: Optional[Mapping[str, float]] = None, state: Optional[State] = None, from_: Optional[State] = None,
             mode: Optional[str] = None, progress: Progress = None, tolerance: float = 1e-12, order: int = 0,
             largest_step: Value = 0.0, step_limit: int = 100_000_000, contacts_at_once: int = 100,
             touch: float = 0.0) -> "Motion":
    """Simulates one motion of a model, without missing a contact.

    time, periods, contacts: how long the motion is: in the model's time, in periods of its phase, or in contacts (20
        periods if none is given). Times are numbers, or expressions in parameters such as "2*pi/omega".
    after, skip: time, or number of periods, that pass before what is shown begins, as to skip a transient.
    phase: the cyclic state whose periods are counted, if the model has several.
    samples, every, at: how many samples are taken at equal distances (500; 0 for none), or at which distance, or at
        which times, counted from the beginning of what is shown.
    derivatives: names of initial states and independent parameters, or "all", with respect to which derivatives of the
        last state are computed.
    dense: keep the polynomials of all steps, so that `motion(t)` gives the states at any time.
    events: names of events: only their contacts are shown and counted; an empty list for none.
    set: other values of parameters, a dict. state (or from_): initial values, a dict by name or a sequence of all; mode:
        the initial mode.
    progress: True for a bar of tqdm, or a function of the finished fraction (None if unknown) and the time; if it
        returns False, the motion is interrupted.
    sections, extrema, quantities, minima, tolerance, order, largest_step, step_limit, contacts_at_once, touch: see
        `Simulation`.

    Returns a Motion. Raises InputError for arguments that cannot be used, and Interrupted, whose `motion` has what was
    computed, by Ctrl-C or `progress`. A motion that ends by itself, as at a singularity, is no error: `motion.ending`
    says how it ended.

    >>> motion = simulate(Model.shipped("bouncing-ball"), contacts=3, samples=0)
    >>> motion.ending, len(motion.contacts)
    ('stopped', 3)
    """
    simulation = Simulation(model, sections=sections, extrema=extrema, quantities=quantities, minima=minima,
                            tolerance=tolerance, order=order, largest_step=largest_step, step_limit=step_limit,
                            contacts_at_once=contacts_at_once, touch=touch)
    return simulation.run(time=time, periods=periods, contacts=contacts, after=after, skip=skip, phase=phase,
                          samples=samples, every=every, at=at, derivatives=derivatives, dense=dense, events=events,
                          set=set, state=state, from_=from_, mode=mode, progress=progress)


def _is_expression(value: Any) -> bool:
    return isinstance(value, (str, _graze.Expression))


def _real(value: Any, name: str) -> float:
    if isinstance(value, (str, bytes)):
        raise InputError(f"{value!r} is no number", "give a number", name)
    try:
        return float(value)
    except OverflowError:
        raise InputError("the number is too large", "give a smaller one", name) from None


def _count(value: Any, name: str, least: int, most: int) -> int:
    try:
        number = operator.index(value)
    except TypeError:
        number = None
    if number is None or isinstance(value, bool) or number < least:
        raise InputError(f"{value!r} is no whole number from {least} on", f"give {least} or more", name)
    if number > most:
        raise InputError(f"{value!r} is too large", f"give {most} or less", name)
    return number


def _text(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a text, not {type(value).__name__}")
    return value


def _names(names: Any, argument: str) -> list:
    if _is_expression(names):
        return [str(names)]
    if isinstance(names, bytes):
        raise TypeError(f"{argument} must be a text or a list of texts, not bytes")
    listed = list(names)
    for name in listed:
        if not _is_expression(name):
            raise TypeError(f"{argument} must be texts or expressions, not {type(name).__name__}")
    return [str(name) for name in listed]


def _items(values: Any, argument: str) -> list:
    if not hasattr(values, "items"):
        raise TypeError(f"{argument} must be a dict, not {type(values).__name__}")
    return list(values.items())


def _times(at: Any, end: Optional[float]) -> list:
    import numpy

    times = numpy.asarray(at, dtype=float)
    if times.ndim != 1:
        raise InputError(f"the times have {times.ndim} dimensions", "give a list", "at")
    if len(times) == 0:
        raise InputError("there are no times", "give one or more", "at")
    if end is not None and times[-1] > end:
        raise InputError(f"the time {times[-1]} is after the end of the motion at {end}", "give a later end", "at")
    return times.tolist()


def _state(model: Model, state: Any, changed: Any = None) -> list:
    if hasattr(state, "items"):
        values = dict((model.with_(**dict(changed)) if changed else model).initial)
        for name, value in state.items():
            if name not in values:
                raise InputError(f"the model has no state {name!r}", f"it has {', '.join(values)}", "state")
            values[name] = _real(value, f"state, {name}")
        return list(values.values())
    if isinstance(state, (str, bytes)):
        raise TypeError("state must be a dict or a list of numbers, not a text")
    return [_real(value, "state") for value in state]


class Motion:
    """A computed motion.

    `motion["x"]` (or `motion.x`) are the sampled values of a state or quantity at the times `motion.t`. Tables, with a
    row each: `samples`; `contacts` (states just before, and with `_after` just after each); `sections`, `extrema`,
    `minima`, `derivatives`: None where they were not asked for; `summary`, of one row.

    `ending` says how the motion ended ("end-time", "stopped": after as many periods or contacts as asked for,
    "terminal", "singular", "table-full", "interrupted", ...), `detail` why, `regular` whether as asked or by the nature
    of the system; `end_time`, `end_state` (a dict) and `end_mode` when and where; `steps` how many steps were made.

    Motions stay valid whatever becomes of model and simulation, and can be pickled.
    """

    def __init__(self, simulation: Simulation, asked: dict, made: Any) -> None:
        self._simulation, self._asked = simulation, asked
        self._core = made
        self._tables: dict = {}
        self._steps: Any = None
        self.ending: str = made.ending
        self.regular: bool = made.regular
        self.detail: str = made.detail
        self.end_time: float = made.time
        self.end_mode: str = made.mode
        self.steps: int = made.steps

    def _table(self, name: str) -> Optional[Table]:
        if name not in self._tables:
            made = self._core.table(name)
            self._tables[name] = None if made is None else Table(*made)
        return self._tables[name]

    def _needed(self, name: str) -> Table:
        table = self._table(name)
        assert table is not None
        return table

    @property
    def samples(self) -> Table:
        """The states, quantities and mode at equal distances or given times; without rows for `samples=0`."""
        table = self._table("samples")
        if table is None:
            import numpy

            units = [self.model.time_unit, "", *(one.unit for one in self.model.states)]
            names = ["time", "mode", *self.model.initial]
            table = Table(names, [[] if name == "mode" else numpy.empty(0) for name in names], units)
            self._tables["samples"] = table
        return table

    @property
    def contacts(self) -> Table:
        """The contacts: time, kind ("crossing", "touch", "sticking"), event, transition, modes before and after, rates
        of the event function before and after, then states and quantities just before, and just after ("_after")."""
        return self._needed("contacts")

    @property
    def sections(self) -> Optional[Table]:
        """The passages of sections: section, time, direction (1: rising, -1), mode, states and quantities."""
        return self._table("sections")

    @property
    def extrema(self) -> Optional[Table]:
        """The extrema of expressions: expression, time, kind, value, mode, whether at a contact, states."""
        return self._table("extrema")

    @property
    def minima(self) -> Optional[Table]:
        """The least value of each watched event function in each arc, with a guaranteed lower bound."""
        return self._table("minima")

    @property
    def derivatives(self) -> Optional[Table]:
        """The derivatives of the last state: state, value, and a column "d_NAME" for each direction. NaN where they do
        not exist, as after a contact without speed."""
        return self._table("derivatives")

    @property
    def summary(self) -> Table:
        """One row: ending, its time, numbers of steps, contacts, touches and stickings, the last mode, the last values of
        states and quantities."""
        table = self._needed("summary")
        return Table(table, [[self.ending] if name == "ending" else column for name, column in table.items()],
                     [table.units.get(name, "") for name in table])

    @property
    def end_state(self) -> dict:
        """The last state, by name."""
        return dict(zip(self.model.initial, self._core.state))

    @property
    def model(self) -> Model:
        """The model as it was simulated (but for `set`, `state` and `mode`)."""
        return self._simulation.model

    @property
    def t(self) -> "numpy.ndarray":
        """The times of the samples."""
        return self.samples["time"]

    def __getitem__(self, name: str) -> Any:
        return self.samples[name]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name == "samples":
            raise AttributeError(name)
        return getattr(self.samples, name)

    def __dir__(self) -> list:
        return [*super().__dir__(), *(name for name in self.samples if name.isidentifier())]

    def __call__(self, times: Any) -> "numpy.ndarray":
        """States at these times, along a further last axis; NaN outside of the motion. At the time of a contact: those
        just before it. Raises InputError unless the motion was simulated with `dense=True`."""
        import numpy

        if not self._asked.get("dense"):
            raise InputError("the steps of this motion were not kept", "simulate it with dense=True")
        if self._steps is None:
            self._steps = self._core.dense()
        asked = numpy.asarray(times, dtype=float)
        states = self._steps.at(asked.ravel())
        return states.reshape(*asked.shape, states.shape[-1])

    def plot(self, quantities: Names = (), portraits: Iterable[Tuple[Any, Any]] = (), *, axes: Any = None) -> Any:
        """Draws histories of quantities (the states), and portraits of pairs of quantities, with contacts marked: the
        motion is computed once more for this. Returns the axes of matplotlib, one or an array."""
        from ._plot import draw

        return draw(self._picture(quantities, portraits), axes)

    def figure(self, quantities: Names = (), portraits: Iterable[Tuple[Any, Any]] = ()) -> Any:
        """The data that `plot` draws."""
        from ._plot import Figure

        return Figure(self._picture(quantities, portraits))

    def _picture(self, quantities: Names = (), portraits: Iterable[Tuple[Any, Any]] = ()) -> Any:
        pairs = [tuple(_names(pair, "portraits")) for pair in portraits]
        if any(len(pair) != 2 for pair in pairs):
            raise InputError("a portrait has two quantities", 'give pairs, as in [("x", "v")]', "portraits")
        asked = {name: value for name, value in self._asked.items() if name not in ("dense", "at", "every", "samples")}
        if "at" in self._asked and not {"time", "periods", "contacts"} & set(asked):
            asked["time"] = self._asked["at"][-1]
        return self._simulation._core.figure(asked, _names(quantities, "quantities"), pairs)

    def to_pandas(self) -> Any:
        """The samples as a pandas DataFrame."""
        return self.samples.to_pandas()

    def to_xarray(self) -> Any:
        """The samples as an xarray Dataset along `time`."""
        data = self.samples.to_xarray()
        return data.set_coords("time").swap_dims(row="time")

    def __reduce__(self) -> Tuple[Any, ...]:
        names = ("samples", "contacts", "sections", "extrema", "minima", "derivatives", "summary")
        tables = {name: table for name in names if (table := self._table(name)) is not None}
        kept = {name: getattr(self._core, name) for name in ("ending", "regular", "detail", "time", "mode", "steps",
                                                             "state")}
        return _motion_again, (self._simulation, self._asked, kept, tables)

    def __repr__(self) -> str:
        return (f"<Motion of {self.model.name}: {len(self.samples)} samples, {len(self.contacts)} contacts, "
                f"ended at {self.end_time:.7g} ({self.ending})>")

    def _repr_html_(self) -> str:
        from ._plot import small_picture

        quick = 20_000  # steps, which are computed again for the picture
        return small_picture(lambda: self._picture() if self.steps <= quick else None, repr(self))


class _Kept:
    """What a motion that was pickled has instead of its compiled part. Its steps are computed once more."""

    def __init__(self, simulation: Simulation, asked: dict, kept: dict) -> None:
        self.__dict__.update(kept)
        self._again = simulation._core, asked

    def table(self, name: str) -> None:
        """All tables that there are were restored."""

    def dense(self) -> Any:
        core, asked = self._again
        return core.run(asked, None).dense()


def _motion_again(simulation: Simulation, asked: dict, kept: dict, tables: dict) -> Motion:
    motion = Motion(simulation, asked, _Kept(simulation, asked, kept))
    motion._tables.update(tables)
    return motion
