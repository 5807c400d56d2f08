"""Models: equations, events and jumps."""

from __future__ import annotations

import html
from collections.abc import Mapping
from typing import Any, Dict, NamedTuple, Optional, Tuple

from . import _graze
from ._arguments import near, path_of
from ._attributes import Fixed
from ._errors import InputError, ModelError, as_kind
from ._expressions import Expression, is_number, number_of, plain, short
from ._model_values import Initial, Parameters, html_table
from ._output import write_file
from ._table import Table


class Described(NamedTuple):
    """A part of a model with its name, unit and meaning."""

    name: str
    unit: str
    text: str


class Finding(NamedTuple):
    """A warning about what is allowed in a model but probably a mistake: the part that it is about, such as
    "events.stop" (empty if it is about no single part), and what is found."""

    part: str
    text: str


class Model(Fixed):
    """A hybrid dynamical system: states, parameters, modes with their equations, events, jumps.

    `Model(text=...)` reads the text of a model file, `Model(file=...)` a file, `Model.shipped(name)` a model that comes
    with graze; `graze.load(name_or_file)` chooses between the last two. With these, keyword arguments set parameters:
    `Model.shipped("impact-oscillator", omega=2.8)`.

    A model is written in Python by its equations. `str(model)` is the text of its file:

    >>> x, v = states(x=1, v=0)
    >>> g, e = parameters(g=9.81, e=0.8)
    >>> ball = Model("ball", parameters=[g, e], rates={x: v, v: -g}, events={"contact": x},
    ...              transitions=[Transition("contact", jump={v: -e*v})])

    name, text, source, time_unit: its name ("model"), what it is, where it comes from, the unit of time.
    states: `State`s in their order, or a dict from names (or symbols) to initial values or to dicts of fields. By
        default those that have rates, in that order.
    parameters: `Parameter`s, or a dict from names (or symbols) to values, expressions or dicts of fields.
    definitions: `Definition`s, or a dict from names to expressions.
    rates, watch: of a model with one mode: see `Mode`. Several modes: modes, a dict from names to `Mode`.
    events: a dict from names to functions or `Event`s. jumps: a dict from names to dicts of changed states or `Jump`s.
    transitions: a list of `Transition`s. sections, symmetries, quantities, conserved: dicts from names to `Section`,
        `Symmetry`, `Quantity`, `Conserved`, or to a function or expression.
    slides, friction: dicts from names to `Slide`s and `Friction`s, of which sliding modes and modes for stick and slip
        are made.
    contacts: `Contacts`, of which events, jumps and modes of closed contacts are made.
    tables: a list of `Interpolant`s that are used in texts; expressions bring theirs with them.
    drawing: what a page shows of a motion, a dict: {"x": (-2, 2), "y": (-1, 1), "shapes": [{"kind": "box", "at": (x, 0),
        "size": (1, 0.5)}, ...]}.
    initial_mode: the mode in which the motion starts; the first one by default.

    An expression is a number, an expression in symbols, or a text. All that docs/model-format.md says of the parts of
    models holds here. Raises ModelError, whose `all` lists all mistakes, and TypeError for unknown arguments.
    """

    def __init__(self, name: Optional[str] = None, *, text: Optional[str] = None, file: Any = None, source: Any = None,
                 time_unit: Any = None, states: Any = None, parameters: Any = None, definitions: Any = None,
                 rates: Any = None, watch: Any = None, modes: Any = None, events: Any = None, jumps: Any = None,
                 transitions: Any = None, slides: Any = None, friction: Any = None, contacts: Any = None,
                 sections: Any = None, symmetries: Any = None, quantities: Any = None, conserved: Any = None,
                 tables: Any = None, drawing: Any = None,
                 initial_mode: Any = None, **values: Any) -> None:
        parts = {"source": source, "time_unit": time_unit, "states": states, "parameters": parameters,
                 "definitions": definitions, "rates": rates, "watch": watch, "modes": modes, "events": events,
                 "jumps": jumps, "transitions": transitions, "slides": slides, "friction": friction,
                 "contacts": contacts, "sections": sections, "symmetries": symmetries, "quantities": quantities,
                 "conserved": conserved, "tables": tables,
                 "drawing": drawing, "initial_mode": initial_mode}
        if rates is not None or modes is not None:
            if file is not None:
                raise ModelError("a model is read from a file or written by its equations, not both",
                                 "leave file, or rates and modes, out")
            self._write(name, text, parts, values)
            return
        if name is not None:
            raise ModelError(f"Model({short(name)}) has no equations",
                             "give rates=..., or modes=...; graze.load(name) reads a shipped model or a file")
        if (text is None) == (file is None):
            raise ModelError("a model is made of one text, of one file, or of its equations",
                             "give text=..., file=..., rates=... or modes=...")
        for key, value in parts.items():
            if value is not None and key != "parameters":
                raise ModelError(f"Model(), {key} belongs to a model that is written by its equations",
                                 "leave it out, or give rates=... or modes=...")
        self._read(text, file)
        for given in ({} if parameters is None else parameters, values):
            self._set(given)

    def _write(self, name: Any, text: Any, parts: Dict[str, Any], values: Dict[str, Any]) -> None:
        from ._written_model import FILE, WrittenModel

        for key in values:
            raise TypeError(f"Model() has no argument {key!r}; {near(key, ['name', 'text', *parts])}")
        written = WrittenModel(name, text=text, **parts)
        try:
            self._core = _graze.Model.parsed(written.text, FILE)
        except InputError as error:
            raise written.told(error) from None

    def _read(self, text: Any, file: Any) -> None:
        try:
            if text is not None:
                if not isinstance(text, str):
                    raise ModelError(f"Model(), text is of type {type(text).__name__}", "give the text of a model file")
                self._core = _graze.Model.parsed(plain(text), "model")
            else:
                path = plain(path_of(file, "a model"))
                self._core = _graze.Model.loaded(path if "/" in path else "./" + path)
        except InputError as error:
            raise as_kind(error, ModelError) from None

    def _instead(self, name: str) -> str:
        for values, called in ((self.parameters, "parameters"), (self.initial, "initial")):
            if name in values:
                return f"set model.{called}.{name}"
        return near(name, ["parameters", "initial", "initial_mode"])

    @classmethod
    def _of(cls, core: Any, parameters: Any = None) -> Model:
        model = cls.__new__(cls)
        model._core = core
        model._set(parameters or {})
        return model

    @classmethod
    def shipped(cls, name: str, **parameters: Any) -> Model:
        """A model that comes with graze; `graze.models()` lists them. Keyword arguments set parameters.

        Raises ModelError if there is none of this name.
        """
        if not isinstance(name, str) or "/" in name or name.endswith(".toml"):
            raise ModelError(f"there is no shipped model {short(name)}",
                             "graze.models() lists them; graze.load reads files")
        return load(name, **parameters)

    def _set(self, parameters: Any) -> None:
        if not isinstance(parameters, Mapping):
            raise ModelError("Model(), parameters is no dict", "give a dict from names to values")
        for name, value in parameters.items():
            self.parameters[name] = value

    def _number(self, value: Any, called: str) -> float:
        """A number, or the value of an expression in parameters."""
        if isinstance(value, (str, Expression)):
            return self._core.value_of(plain(value), called)
        if not is_number(value):
            raise ModelError(f"{short(value)} is no number", "give a number, or an expression in parameters", called)
        try:
            return number_of(value)
        except InputError as error:
            raise ModelError(error.problem, error.remedy, called) from None

    def with_(self, **values: Any) -> Model:
        """A copy with other values of parameters or initial states."""
        copy = self.__copy__()
        states = set(copy.initial)
        for name, value in values.items():
            (copy.initial if name in states else copy.parameters)[name] = value
        return copy

    @property
    def name(self) -> str:
        """The name of the model."""
        return self._core.name

    @property
    def text(self) -> str:
        """What it is, in words."""
        return self._core.description

    @property
    def source(self) -> str:
        """Where it comes from."""
        return self._core.source

    @property
    def time_unit(self) -> str:
        """The unit of time; may be empty."""
        return self._core.time_unit

    @property
    def parameters(self) -> Parameters:
        """The parameters, by name; they can be set."""
        return Parameters(self)

    @property
    def initial(self) -> Initial:
        """The initial values of the states, by name; they can be set."""
        return Initial(self)

    @property
    def initial_mode(self) -> str:
        """The name of the mode in which the motion starts; it can be set."""
        return self._core.initial_mode

    @initial_mode.setter
    def initial_mode(self, name: str) -> None:
        try:
            self._core.initial_mode = plain(name)
        except InputError as error:
            raise as_kind(error, ModelError) from None

    @property
    def states(self) -> Tuple[Described, ...]:
        """The states: (name, unit, text) of each."""
        return tuple(Described(one["name"], one["unit"], one["text"]) for one in self._core.states)

    @property
    def periods(self) -> Dict[str, float]:
        """Periods of the cyclic states, at the present parameters."""
        periods = zip((one.name for one in self.states), self._core.periods())
        return {name: period for name, period in periods if period > 0}

    @property
    def definitions(self) -> Tuple[str, ...]:
        """Names of the definitions."""
        return tuple(name for name, _ in self._core.definitions)

    @property
    def modes(self) -> Tuple[str, ...]:
        """Names of the modes."""
        return tuple(name for name, _ in self._core.modes)

    @property
    def events(self) -> Tuple[str, ...]:
        """Names of the events."""
        return tuple(name for name, _ in self._core.events)

    @property
    def jumps(self) -> Tuple[str, ...]:
        """Names of the jumps; the first is `identity`."""
        return tuple(name for name, _ in self._core.jumps)

    @property
    def sections(self) -> Tuple[str, ...]:
        """Names of the sections."""
        return tuple(name for name, _ in self._core.sections)

    @property
    def symmetries(self) -> Tuple[str, ...]:
        """Names of the symmetries."""
        return tuple(name for name, _ in self._core.symmetries)

    @property
    def transitions(self) -> Tuple[Tuple[str, str, str, str], ...]:
        """(label, mode, event, jump) of each transition."""
        return tuple(self._core.transitions)

    @property
    def quantities(self) -> Tuple[str, ...]:
        """Names of the quantities."""
        return tuple(name for name, *_ in self._core.quantities)

    @property
    def conserved(self) -> Tuple[str, ...]:
        """Names of the conserved quantities, along which families of orbits can be followed."""
        return tuple(name for name, *_ in self._core.conserved)

    def value(self, expression: Any) -> float:
        """The value of a number or of an expression in parameters, as a text too, at the present parameters.

        Raises ModelError if it has none.
        """
        try:
            return self._number(expression, "value()")
        except InputError as error:
            raise as_kind(error, ModelError) from None

    def check(self) -> Tuple[Finding, ...]:
        """What is allowed but probably a mistake, as `graze check` warns: an event that no mode watches, a mode that
        cannot be reached, an initial state beyond a barrier, a symmetry that does not hold, ... Empty if nothing is
        found. It takes a second or two for large models."""
        return tuple(Finding(*one) for one in self._core.findings())

    def describe(self) -> str:
        """A readable text of all states, parameters, modes and other parts, as `graze check` prints it."""

        import textwrap

        lines = [self.name + (f" (time in {self.time_unit})" if self.time_unit else "")]
        for words in (self.text, self.source and f"Source: {self.source}"):
            if words:
                words = " ".join(words.split())
                lines.append(textwrap.fill(words, 100, break_long_words=False, break_on_hyphens=False))
        return "\n".join(lines) + "\n" + self._core.listing()

    def table(self) -> Any:
        """A Table with one row for every named item: item, name, value, unit, text."""
        return Table(*self._core.table())

    def save(self, path: Any) -> None:
        """Writes the model file. An existing file is replaced, but for a result file. Raises FileError if it cannot be
        written."""
        write_file(path, str(self))

    def __str__(self) -> str:
        return self._core.text()

    def __eq__(self, other: object) -> bool:
        return bool(str(self) == str(other)) if isinstance(other, Model) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __copy__(self) -> Model:
        return type(self)._of(self._core.copied())

    def __deepcopy__(self, memo: Any) -> Model:
        return self.__copy__()

    def __reduce__(self) -> Tuple[Any, ...]:
        return _read_again, (str(self),)

    def __repr__(self) -> str:
        states = ", ".join(one.name for one in self.states)
        modes = f"; modes {', '.join(self.modes)}" if len(self.modes) > 1 else ""
        return f"<Model {self.name}: states {states}{modes}>"

    def _repr_html_(self) -> str:
        said = f"<b>{html.escape(self.name)}</b>"
        if self.text:
            said += f"<p>{html.escape(self.text)}</p>"
        said += html_table(("state", "initial", "unit", ""), self.initial._rows())
        if self.parameters:
            said += html_table(("parameter", "value", "unit", ""), self.parameters._rows())
        said += f"<p>modes {html.escape(', '.join(self.modes))}"
        if self.transitions:
            said += "; transitions " + html.escape(", ".join(label for label, *_ in self.transitions))
        return said + "</p>"


def _read_again(text: str) -> Model:
    return Model(text=text)


def load(name_or_file: Any, **parameters: Any) -> Model:
    """A shipped model by its name, or the model in a file. Keyword arguments set parameters.

    Raises ModelError, whose `all` lists all mistakes, and FileError for a file that cannot be read.
    """
    try:
        core = _graze.Model.loaded(plain(path_of(name_or_file, "a model")))
    except InputError as error:
        raise as_kind(error, ModelError) from None
    return Model._of(core, parameters)


def models() -> Dict[str, str]:
    """The models that come with graze: name -> what it is."""
    return dict(_graze.shipped_models())
