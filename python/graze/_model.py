"""Models: equations, events and jumps."""

from __future__ import annotations

import html
import os
from collections.abc import MutableMapping
from typing import NamedTuple, Optional

from . import _graze
from ._errors import InputError, ModelError, as_kind


class Described(NamedTuple):
    """A part of a model with its name, unit and meaning."""

    name: str
    unit: str
    text: str


class Parameters(MutableMapping):
    """The parameters of a model: a mapping from names to values, which are attributes too.

    Independent parameters can be set; those that follow from others change with them. `units` and `texts` are dicts.

    >>> parameters = Model.shipped("impact-oscillator").parameters
    >>> parameters.omega = 2.8
    >>> parameters["omega"]
    2.8
    """

    def __init__(self, model: "Model"):
        object.__setattr__(self, "_model", model)

    def _values(self) -> dict:
        core = self._model._core
        return dict(zip((one["name"] for one in core.parameters), core.parameter_values()))

    def __getitem__(self, name):
        values = self._values()
        if name not in values:
            raise KeyError(f"the model has no parameter {name!r}; it has {', '.join(values)}")
        return values[name]

    def __setitem__(self, name, value):
        self._model._change()
        try:
            self._model._core.set_parameter(name, float(value))
        except InputError as error:
            raise as_kind(error, ModelError) from None

    def __delitem__(self, name):
        raise InputError("parameters cannot be removed from a model", "")

    def __iter__(self):
        return (one["name"] for one in self._model._core.parameters)

    def __len__(self):
        return len(self._model._core.parameters)

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __setattr__(self, name, value):
        self[name] = value

    def __dir__(self):
        return [*super().__dir__(), *self]

    @property
    def units(self) -> dict:
        return {one["name"]: one["unit"] for one in self._model._core.parameters}

    @property
    def texts(self) -> dict:
        return {one["name"]: one["text"] for one in self._model._core.parameters}

    @property
    def independent(self) -> tuple:
        """Names of the parameters that do not follow from others."""
        return tuple(self._model._core.independent_parameters())

    def __repr__(self):
        return "{" + ", ".join(f"{name}: {value:.7g}" for name, value in self.items()) + "}"


class Initial(MutableMapping):
    """The initial values of a model's states, by name; they can be set."""

    def __init__(self, model: "Model"):
        self._model = model

    def _values(self) -> dict:
        core = self._model._core
        return dict(zip((one["name"] for one in core.states), core.initial_state()))

    def __getitem__(self, name):
        values = self._values()
        if name not in values:
            raise KeyError(f"the model has no state {name!r}; it has {', '.join(values)}")
        return values[name]

    def __setitem__(self, name, value):
        self._model._change()
        try:
            self._model._core.set_initial(name, float(value))
        except InputError as error:
            raise as_kind(error, ModelError) from None

    def __delitem__(self, name):
        raise InputError("states cannot be removed from a model", "")

    def __iter__(self):
        return (one["name"] for one in self._model._core.states)

    def __len__(self):
        return len(self._model._core.states)

    def __repr__(self):
        return "{" + ", ".join(f"{name}: {value:.7g}" for name, value in self.items()) + "}"


class Model:
    """A hybrid dynamical system: states, parameters, modes with their equations, events, jumps.

    `Model(text=...)` reads the text of a model file, `Model(file=...)` a file, `Model.shipped(name)` a model that comes
    with graze; `graze.load(name_or_file)` chooses between the last two. `str(model)` is the text of its file.
    Keyword arguments set parameters: `Model.shipped("impact-oscillator", omega=2.8)`.

    Raises ModelError, whose `all` lists all mistakes of a text.
    """

    def __init__(self, *, text: Optional[str] = None, file=None, **parameters):
        if (text is None) == (file is None):
            raise InputError("a model is made of one text or one file", "give text=... or file=...")
        try:
            if text is not None:
                self._core = _graze.Model.parsed(text, "model")
            else:
                path = os.fspath(file)
                self._core = _graze.Model.loaded(path if "/" in path else "./" + path)
        except InputError as error:
            raise as_kind(error, ModelError) from None
        self._compiled = None
        self._set(parameters)

    @classmethod
    def _of(cls, core, parameters=None) -> "Model":
        model = cls.__new__(cls)
        model._core = core
        model._compiled = None
        model._set(parameters or {})
        return model

    @classmethod
    def shipped(cls, name: str, **parameters) -> "Model":
        """A model that comes with graze; `graze.models()` lists them."""
        try:
            return cls._of(_graze.Model.loaded(name), parameters)
        except InputError as error:
            raise as_kind(error, ModelError) from None

    def _set(self, parameters):
        for name, value in parameters.items():
            self.parameters[name] = value

    def _change(self):
        self._compiled = None

    def with_(self, **values) -> "Model":
        """A copy with other values of parameters or initial states."""
        copy = Model._of(self._core.copied())
        states = set(copy.initial)
        for name, value in values.items():
            (copy.initial if name in states else copy.parameters)[name] = value
        return copy

    @property
    def name(self) -> str:
        return self._core.name

    @property
    def text(self) -> str:
        """What it is, in words."""
        return self._core.description

    @property
    def source(self) -> str:
        return self._core.source

    @property
    def time_unit(self) -> str:
        return self._core.time_unit

    @property
    def parameters(self) -> Parameters:
        return Parameters(self)

    @property
    def initial(self) -> Initial:
        return Initial(self)

    @property
    def initial_mode(self) -> str:
        return self._core.initial_mode

    @initial_mode.setter
    def initial_mode(self, name: str):
        self._change()
        try:
            self._core.initial_mode = name
        except InputError as error:
            raise as_kind(error, ModelError) from None

    @property
    def states(self) -> tuple:
        """Names of the states, with unit and text."""
        return tuple(Described(one["name"], one["unit"], one["text"]) for one in self._core.states)

    @property
    def modes(self) -> tuple:
        return tuple(name for name, _ in self._core.modes)

    @property
    def events(self) -> tuple:
        return tuple(name for name, _ in self._core.events)

    @property
    def sections(self) -> tuple:
        return tuple(name for name, _ in self._core.sections)

    @property
    def transitions(self) -> tuple:
        """(label, mode, event, jump) of each transition."""
        return tuple(self._core.transitions)

    @property
    def quantities(self) -> tuple:
        return tuple(name for name, *_ in self._core.quantities)

    def save(self, path) -> None:
        """Writes the model file. An existing file is replaced."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(str(self))

    def __str__(self):
        return self._core.text()

    def __eq__(self, other):
        return str(self) == str(other) if isinstance(other, Model) else NotImplemented

    __hash__ = None

    def __copy__(self):
        return Model._of(self._core.copied())

    def __deepcopy__(self, memo):
        return self.__copy__()

    def __reduce__(self):
        return _read_again, (str(self),)

    def __repr__(self):
        states = ", ".join(one.name for one in self.states)
        return f"<Model {self.name}: states {states}; modes {', '.join(self.modes)}>"

    def _repr_html_(self):
        rows = "".join(
            f"<tr><td>{html.escape(one['name'])}</td><td>{value:.7g}</td><td>{html.escape(one['unit'])}</td>"
            f"<td>{html.escape(one['text'])}</td></tr>"
            for one, value in zip(self._core.parameters, self._core.parameter_values())
        )
        states = ", ".join(html.escape(one.name) for one in self.states)
        return (f"<b>{html.escape(self.name)}</b><p>{html.escape(self.text)}</p><p>states {states}; "
                f"modes {html.escape(', '.join(self.modes))}</p><table><tbody>{rows}</tbody></table>")


def _read_again(text: str) -> Model:
    return Model(text=text)


def load(name_or_file) -> Model:
    """A shipped model by its name, or the model in a file."""
    try:
        return Model._of(_graze.Model.loaded(os.fspath(name_or_file)))
    except InputError as error:
        raise as_kind(error, ModelError) from None


def models() -> dict:
    """The models that come with graze: name -> what it is."""
    return dict(_graze.shipped_models())
