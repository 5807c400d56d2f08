"""Simulations of a model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from . import _arguments as checked, _graze
from ._arguments import near
from ._attributes import Fixed
from ._errors import InputError, Interrupted, WrongType
from ._model import Model
from ._motion import Motion, Names
from ._progress import Progress, interruptible, telling

if TYPE_CHECKING:
    import numpy


Value = Union[float, str, _graze.Expression]
"""A number, or an expression in parameters."""

State = Union[Mapping[str, float], Sequence[float], "numpy.ndarray[Any, Any]"]
"""Initial values: by name, where the others are the model's, or of all states in their order."""

_MOST_ROWS = 10_000_000  # of samples, as in the program


class Simulation(Fixed):
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

    model: Model

    def __init__(self, model: Model, *, sections: Names = (), extrema: Names = (), quantities: Names = (),
                 minima: bool = False, tolerance: float = 1e-12, order: int = 0, largest_step: Value = 0.0,
                 step_limit: int = 100_000_000, contacts_at_once: int = 100, touch: float = 0.0) -> None:
        if not isinstance(model, Model):
            raise TypeError(f"a simulation needs a graze.Model, not {type(model).__name__}")
        self.model = model.with_()
        step = self.model._number(largest_step, "largest_step") if checked.is_expression(largest_step) else largest_step
        self._settings: Dict[str, Any] = {
            "sections": checked.names(sections, "sections"), "extrema": checked.names(extrema, "extrema"),
            "quantities": checked.names(quantities, "quantities"), "minima": checked.truth(minima, "minima"),
            "tolerance": checked.number(tolerance, "tolerance"), "order": checked.whole(order, "order", 0, 1000),
            "largest_step": checked.number(step, "largest_step", finite=False),
            "step_limit": checked.whole(step_limit, "step_limit", 0, 2**63 - 1),
            "contacts_at_once": checked.whole(contacts_at_once, "contacts_at_once", 0, 2**31 - 1),
            "touch": checked.number(touch, "touch")}
        self._core = _graze.Simulation(model._core, **self._settings)

    def run(self, *, time: Optional[Value] = None, periods: Optional[int] = None, contacts: Optional[int] = None,
            after: Optional[Value] = None, skip: Optional[int] = None, phase: Optional[str] = None,
            samples: Optional[int] = None, every: Optional[Value] = None, at: Any = None, derivatives: Names = (),
            dense: bool = False, events: Optional[Names] = None, set: Optional[Mapping[str, float]] = None,
            state: Optional[State] = None, from_: Optional[State] = None, mode: Optional[str] = None,
            progress: Progress = None) -> Motion:
        """Computes one motion; the arguments are those of `simulate`. set: other values of parameters."""
        asked: Dict[str, Any] = {}
        if set is not None:
            asked["set"] = checked.settings(set)
        if time is not None:
            asked["time"] = self._positive(time, "time", asked)
        if after is not None:
            asked["after"] = self._positive(after, "after", asked)
        if every is not None:
            asked["every"] = self._positive(every, "every", asked)
        if periods is not None:
            asked["periods"] = checked.whole(periods, "periods", 1, 2**31 - 1)
        if contacts is not None:
            asked["contacts"] = checked.whole(contacts, "contacts", 1, 2**31 - 1)
        if skip is not None and checked.whole(skip, "skip", 0, 2**31 - 1):
            asked["skip"] = checked.whole(skip, "skip")
        if phase is not None:
            asked["phase"] = checked.text(phase, "phase")
        if (samples is not None) + (every is not None) + (at is not None) > 1:
            raise InputError("samples, every and at contradict each other", "give one of them")
        if samples is not None:
            asked["samples"] = checked.whole(samples, "samples", 0, _MOST_ROWS)
            if samples == 1:
                raise InputError("one sample has no distance to the next", "give 2 or more, or 0 for none", "samples")
        if at is not None:
            asked["at"] = _times(at, asked.get("time"))
        directions = self._directions(derivatives)
        if directions:
            asked["derivatives"] = directions
        if checked.truth(dense, "dense"):
            asked["dense"] = True
        if events is not None:
            asked["events"] = checked.names(events, "events")
        if from_ is not None:
            if state is not None:
                raise InputError("state and from_ are the same", "give one of them")
            state = from_
        if state is not None:
            asked["state"] = _state(self.model, state, asked.get("set"))
        if mode is not None:
            asked["mode"] = checked.text(mode, "mode")
        with telling(progress, "time") as told:
            made = self._core.run(asked, told)
        raised = made.raised
        if raised is None:
            return Motion(self, asked, made)
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted(Motion(self, asked, made)) from None
        raise raised

    def _positive(self, value: Value, name: str, asked: Dict[str, Any]) -> float:
        if checked.is_expression(value):
            value = self._core.value_of(checked.text(str(value), name), asked.get("set", []), name)
        return checked.number(value, name, above=0)

    def _directions(self, names: Names) -> List[str]:
        chosen = checked.names(names, "derivatives")
        known = [*self.model.initial, *self.model.parameters.independent]
        if chosen == ["all"]:
            return known
        for name in chosen:
            if name not in known:
                raise InputError(f"the model has no state or independent parameter {name!r}",
                                 f"it has {', '.join(known)}", "derivatives")
        return chosen

    def _instead(self, name: str) -> str:
        if name in self._settings:
            return f"give it when the simulation is made: Simulation(model, {name}=...)"
        return near(name, ["model", *self._settings])

    def __repr__(self) -> str:
        return f"<Simulation of {self.model.name}>"

    def __reduce__(self) -> Tuple[Any, ...]:
        return _simulation_again, (self.model, self._settings)

    def __copy__(self) -> "Simulation":
        return self  # nothing of it changes

    def __deepcopy__(self, memo: Any) -> "Simulation":
        return self


def _simulation_again(model: Model, settings: Dict[str, Any]) -> Simulation:
    return Simulation(model, **settings)


@interruptible()
def simulate(model: Model, *, time: Optional[Value] = None, periods: Optional[int] = None,
             contacts: Optional[int] = None, after: Optional[Value] = None, skip: Optional[int] = None,
             phase: Optional[str] = None, samples: Optional[int] = None, every: Optional[Value] = None, at: Any = None,
             derivatives: Names = (), dense: bool = False, events: Optional[Names] = None, sections: Names = (),
             extrema: Names = (), quantities: Names = (), minima: bool = False,
             set: Optional[Mapping[str, float]] = None, state: Optional[State] = None, from_: Optional[State] = None,
             mode: Optional[str] = None, progress: Progress = None, tolerance: float = 1e-12, order: int = 0,
             largest_step: Value = 0.0, step_limit: int = 100_000_000, contacts_at_once: int = 100,
             touch: float = 0.0) -> Motion:
    """Simulates one motion of a model, without missing a contact.

    time, periods, contacts: how long the motion is: in the model's time, in periods of its phase, or in contacts (20
        periods if none is given). Times are numbers, or expressions in parameters such as "2*pi/omega".
    after, skip: time, or number of periods, that pass before what is shown begins, as to skip a transient.
    phase: the cyclic state whose periods are counted, if the model has several.
    samples, every, at: how many samples are taken at equal distances (500; 0 for none), or at which distance, or at
        which times, counted from the beginning of what is shown.
    derivatives: names of initial states and independent parameters, or "all", with respect to which derivatives of the
        last state are computed. A derivative by a parameter is that with the initial state held, also where the initial
        state follows from the parameter.
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


def _times(at: Any, end: Optional[float]) -> List[float]:
    times = checked.numbers(at, "at")
    if times.ndim != 1:
        raise InputError(f"the times have {times.ndim} dimensions", "give a list", "at")
    if len(times) == 0:
        raise InputError("there are no times", "give one or more", "at")
    if len(times) > _MOST_ROWS:
        raise InputError(f"there are {len(times)} times", f"give {_MOST_ROWS} or fewer", "at")
    if end is not None and times[-1] > end:
        raise InputError(f"the time {times[-1]} is after the end of the motion at {end}", "give a later end", "at")
    return list(map(float, times))


def _state(model: Model, state: Any, changed: Any = None) -> List[float]:
    if hasattr(state, "items"):
        values = dict((model.with_(**dict(changed)) if changed else model).initial)
        for name, value in state.items():
            if name not in values:
                raise InputError(f"the model has no state {name!r}", f"it has {', '.join(values)}", "state")
            values[name] = checked.number(value, f"state, {name}")
        return list(values.values())
    if isinstance(state, (str, bytes)) or not hasattr(state, "__iter__") or getattr(state, "ndim", 1) == 0:
        raise checked.wrong(state, "state", "does not say the values of states",
                            f"give a dict, or a list of numbers: of {', '.join(model.initial)}", WrongType)
    return [checked.number(value, "state") for value in state]
