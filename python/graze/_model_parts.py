"""The parts of models written in Python: states, parameters and definitions as symbols with fields, and the other parts,
which are what their fields say."""

from __future__ import annotations

import math
from typing import Any, Dict, Tuple

from . import _graze
from ._errors import InputError, ModelError, as_kind
from ._expressions import Expression, is_number, number_of, short, words_of


class _Symbol(Expression):
    """A symbol with fields."""

    _kind = ""

    def __new__(cls, name: Any, *others: Any, **fields: Any) -> Any:
        try:
            return super().__new__(cls, name)
        except InputError as error:
            raise as_kind(error, ModelError) from None

    def __init__(self, name: Any, **fields: Any) -> None:
        vars(self).update(fields)

    @property
    def name(self) -> str:
        return str(self)

    def __reduce__(self) -> Tuple[Any, ...]:
        return _made_again, (type(self), str(self), dict(vars(self)))


def _made_again(kind: Any, name: Any, fields: Any) -> Any:
    return kind(name, **fields)


class State(_Symbol):
    """A state of a model, to be used in expressions.

    initial: its initial value, a number or an expression in parameters. unit, text: its unit and meaning.
    period: a number or expression makes the state cyclic: it is kept in [0, period).
    drifting: orbits are periodic up to a shift of this state.

    >>> theta = State("theta", period="2*pi", text="phase")
    """

    _kind = "state"
    initial: Any
    unit: str
    text: str
    period: Any
    drifting: bool

    def __init__(self, name: Any, initial: Any = 0, *, unit: str = "", text: str = "", period: Any = None,
                 drifting: bool = False) -> None:
        super().__init__(name, initial=initial, unit=unit, text=text, period=period, drifting=drifting)


class Parameter(_Symbol):
    """A parameter of a model, to be used in expressions.

    value: a number (the parameter is independent: it can be set later), or an expression in other parameters, which it
    then follows. unit, text: its unit and meaning.

    >>> f = Parameter("f", 50, unit="Hz")
    >>> omega = Parameter("omega", 2*3.14159*f)
    """

    _kind = "parameter"
    value: Any
    unit: str
    text: str

    def __init__(self, name: Any, value: Any = None, *, unit: str = "", text: str = "") -> None:
        super().__init__(name, value=value, unit=unit, text=text)


class Definition(_Symbol):
    """A name for an expression, to be used in other expressions. What several equations share is computed once, with or
    without a name; with one it is also shown by its name.

    >>> x, k = symbols("x k")
    >>> force = Definition("force", -k*x, text="of the spring")
    """

    _kind = "definition"
    value: Any
    text: str

    def __init__(self, name: Any, value: Any, *, text: str = "") -> None:
        super().__init__(name, value=value, text=text)


def _several(kind: Any, called: str, names: str, values: Dict[str, Any]) -> Any:
    made = [kind(word) for word in words_of(names, called)] if not isinstance(names, str) or names or not values else []
    made += [kind(name, value) for name, value in values.items()]
    return made[0] if len(made) == 1 else tuple(made)


def states(names: str = "", **initial: Any) -> Any:
    """States by their names: one, or a tuple of several. By keyword, with their initial values (0 otherwise).

    >>> x, v = states("x v")
    >>> x, v = states(x=1, v=0)
    """
    return _several(State, "states", names, initial)


def parameters(names: str = "", **values: Any) -> Any:
    """Parameters by their names: one, or a tuple of several. By keyword, with their values.

    >>> k, c = parameters("k c")
    >>> k, c = parameters(k=1, c=0.1)
    """
    return _several(Parameter, "parameters", names, values)


class Part:
    """A part of a model, which is what its fields say."""

    _what = ""

    def __eq__(self, other: object) -> bool:
        return bool(vars(self) == vars(other)) if type(self) is type(other) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        said = ", ".join(f"{name}={value!r}" for name, value in vars(self).items()
                         if not (value is None or isinstance(value, str) and value == ""))
        return f"{type(self).__name__}({said})"


class Mode(Part):
    """The equations of motion between events.

    rates: a dict from states, or their names, to their time derivatives. watch: names of the events that can happen,
    of which simultaneous ones are processed in this order; by default those for which there is a transition in this
    mode. text: what the mode is.
    """

    _what = "a mode"

    def __init__(self, rates: Any, *, watch: Any = None, text: str = "") -> None:
        self.rates, self.watch, self.text = rates, watch, text


class Event(Part):
    """An event: `function` falls through zero in a mode that watches it.

    kind: "barrier", which the motion must not cross, or "section", which only marks where something changes. text: what
    the event is.
    """

    _what = "an event"

    def __init__(self, function: Any, *, kind: str = "barrier", text: str = "") -> None:
        self.function, self.kind, self.text = function, kind, text


class Jump(Part):
    """A map of states: `changes` is a dict from states, or their names, to their values after the jump, in terms of the
    states before. Other states stay as they are. text: what the jump is."""

    _what = "a jump"

    def __init__(self, changes: Any, *, text: str = "") -> None:
        self.changes, self.text = changes, text


class Transition(Part):
    """The effect of an event in a mode.

    event: the name of the event. mode: the name of the mode (may be left out if there is only one).
    jump: the name of a jump, or a Jump or dict of changed states. Without it states stay as they are.
    next: the name of the mode that follows, or "end" for the end of the motion; by default the mode stays. Or a list of
        alternatives, pairs (condition, name) and at last perhaps a name: the first whose condition holds in the state
        after the jump is taken.
    chatter: how the motion goes on when contacts accumulate: the name of a mode, or a pair (jump, name).
    label: a name for signatures of orbits ("mode:event" if it is left out).
    when: a condition on the state before the jump: of several transitions of one event in a mode the first whose
        condition holds is made. also: names of further events that happen at the same instant.

    >>> x, v = states("x v")
    >>> bounce = Transition("contact", jump={v: -0.8*v}, next=[(v > 0.01, "flight"), "rest"], mode="flight")
    """

    _what = "a transition"

    def __init__(self, event: Any, *, mode: Any = None, jump: Any = None, next: Any = None, chatter: Any = None,
                 label: str = "", when: Any = None, also: Any = ()) -> None:
        self.event, self.mode, self.jump, self.next = event, mode, jump, next
        self.chatter, self.label, self.when, self.also = chatter, label, when, also


class Slide(Part):
    """Two modes that meet at a surface without a jump: the motion slides along it where both push towards it. The
    sliding mode has the name of the slide; its equations, events and transitions are derived.

    surface: the name of an event, a barrier. between: the mode in which its function is negative, then that in which it
    is positive. convention: "filippov" (the default), or "utkin"; then control is a name in the rates of both modes, -1
    in the first and 1 in the second. watch: events of the sliding mode besides those that end it; by default those
    that both modes watch. text: what the slide is.
    """

    _what = "a slide"

    def __init__(self, surface: Any, between: Any, *, convention: Any = None, control: Any = None, watch: Any = None,
                 text: str = "") -> None:
        self.surface, self.between, self.convention = surface, between, convention
        self.control, self.watch, self.text = control, watch, text


class Friction(Part):
    """Dry friction. Its name stands in rates for the force against a positive `velocity`: each mode with it becomes
    modes for both directions and for rest.

    velocity: of one body relative to the other. normal: the force that presses them together. coefficient: of friction
    during slip. static: of the greatest friction at rest; by default the same. text: what it is.
    """

    _what = "a friction"

    def __init__(self, velocity: Any, normal: Any, coefficient: Any, *, static: Any = None, text: str = "") -> None:
        self.velocity, self.normal, self.coefficient = velocity, normal, coefficient
        self.static, self.text = static, text


class Contact(Part):
    """Two bodies that cannot penetrate each other: an event, jumps, and modes in which the contact is closed are made.

    gap: their distance, positive while the contact is open. restitution: of the law of impact. friction: its
    coefficient, and slip: the velocity of the bodies along each other. text: what it is.
    """

    _what = "a contact"

    def __init__(self, gap: Any, restitution: Any, *, friction: Any = None, slip: Any = None, text: str = "") -> None:
        self.gap, self.restitution = gap, restitution
        self.friction, self.slip, self.text = friction, slip, text


class Contacts(Part):
    """The contacts of a model: `contacts` is a dict from names to `Contact`s.

    mass: a dict from the states that impulses change to their masses; or the mass matrix, a list of rows, with
    velocities, the list of these states. law: "newton" (the default), "moreau", "poisson" or "sequence". modes: the
    names of the modes in which the contacts exist; by default all.

    >>> x, v = states(x=1, v=0)
    >>> ball = Model("ball", rates={x: v, v: -9.81}, contacts=Contacts({"floor": Contact(x, 0.8)}, mass={v: 1}))
    """

    _what = "contacts"

    def __init__(self, contacts: Any, mass: Any, *, velocities: Any = None, law: Any = None, modes: Any = None) -> None:
        self.contacts, self.mass, self.velocities = contacts, mass, velocities
        self.law, self.modes = law, modes


class Section(Part):
    """A surface at which states are recorded: a zero of `function`, passed in the `direction` "falling", "rising" or
    "both" (the default); or where the cyclic `state` passes `value`. text: what the section is."""

    _what = "a section"

    def __init__(self, function: Any = None, *, state: Any = None, value: Any = None, direction: Any = None,
                 text: str = "") -> None:
        self.function, self.state, self.value = function, state, value
        self.direction, self.text = direction, text


class Symmetry(Part):
    """A map that takes solutions of the model to solutions. map: the changed states, as in jumps; modes: a dict from
    each mode that is mapped to another one to that mode. text: what the symmetry is."""

    _what = "a symmetry"

    def __init__(self, map: Any = None, *, modes: Any = None, text: str = "") -> None:
        self.map, self.modes, self.text = map, modes, text


class Conserved(Part):
    """An expression that no motion changes, such as an energy; with `modes`, a dict from modes to expressions, where
    that differs between modes."""

    _what = "a conserved quantity"

    def __init__(self, value: Any = None, *, modes: Any = None, unit: str = "", text: str = "") -> None:
        self.value, self.modes, self.unit, self.text = value, modes, unit, text


class Quantity(Part):
    """A further expression for tables and figures, with its unit and meaning."""

    _what = "a quantity"

    def __init__(self, value: Any, *, unit: str = "", text: str = "") -> None:
        self.value, self.unit, self.text = value, unit, text


class Interpolant(Part):
    """A function of one number that is known at some points, such as a recorded input or a measured force. Called with
    an expression it gives an expression, called with a number its value.

    name: what model files call it. points: pairs (x, f) with increasing x, or an array of two columns.
    interpolation: "linear", or "cubic" for a spline. periodic: the last point repeats the first one, a period later.
    outside: the value beyond the points: "hold" for that at the end (the default), "linear" for the straight line
    with the slope at the end, "error" for none, where a motion ends. text: what it is.

    A model that is written with it has it in its `[tables]`. Raises ModelError for points out of order.

    >>> spring = Interpolant("spring", [(-0.1, -9), (0, 0), (0.1, 9)], outside="linear")
    >>> spring(0.05)
    4.5
    >>> x, v = states("x v")
    >>> seat = Model("seat", rates={x: v, v: -spring(x) - 0.4*v})
    """

    _what = "an interpolant"

    def __init__(self, name: str, points: Any, *, interpolation: str = "linear", periodic: bool = False,
                 outside: str = "hold", text: str = "") -> None:
        self.name, self.interpolation, self.periodic = name, interpolation, bool(periodic)
        self.outside, self.text = outside, text
        self.points = tuple(_point(one, number) for number, one in enumerate(points))
        try:
            self._made()
        except InputError as error:
            raise as_kind(error, ModelError) from None

    def _made(self) -> Any:
        return _graze.PieceTable(self.name, self.points, self.interpolation, self.periodic, self.outside, self.text)

    def __call__(self, at: Any) -> Any:
        if isinstance(at, Expression):
            return self._made().look_up(at)
        value = self._made().value(number_of(at) if is_number(at) else math.nan)
        if math.isnan(value):
            raise InputError(f"{self.name}({short(at)}) is no number",
                             "give an expression, or a number at which the function is known")
        return value


def _point(given: Any, number: int) -> Tuple[float, float]:
    try:
        x, f = given
        return number_of(x), number_of(f)
    except (TypeError, ValueError, InputError):
        raise ModelError(f"Interpolant(), points[{number}], {short(given)}, is no pair of numbers",
                         "give pairs (x, f), or an array of two columns") from None
