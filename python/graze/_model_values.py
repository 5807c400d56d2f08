"""Parameters and initial values of models: mappings whose items are attributes too."""

from __future__ import annotations

import html
from collections.abc import MutableMapping
from typing import TYPE_CHECKING, Any, Dict, Iterable, Iterator, List, Tuple

from ._errors import InputError, ModelError, as_kind
from ._expressions import Expression, plain, short

if TYPE_CHECKING:
    from ._model import Model


class _Values(MutableMapping):  # type: ignore[type-arg]
    """Values of parts of a model by their names: a mapping whose items are attributes too."""

    _kind = ""
    _set = ""

    def __init__(self, model: Model) -> None:
        object.__setattr__(self, "_model", model)

    def _parts(self) -> List[Dict[str, Any]]:
        raise NotImplementedError

    def _numbers(self) -> List[float]:
        raise NotImplementedError

    def _unknown(self, name: Any) -> str:
        return f"the model has no {self._kind} {short(name)}; it has {', '.join(self) or 'none'}"

    def __getitem__(self, name: Any) -> Any:
        if isinstance(name, (str, Expression)):
            for part, value in zip(self._parts(), self._numbers()):
                if part["name"] == str(name):
                    return value
        raise KeyError(self._unknown(name))

    def __setitem__(self, name: Any, value: Any) -> None:
        model = self._model
        try:
            name = plain(name)
            getattr(model._core, self._set)(name, model._number(value, name))
        except InputError as error:
            raise as_kind(error, ModelError) from None

    def __delitem__(self, name: Any) -> None:
        raise InputError(f"a {self._kind} cannot be removed from a model", "write another model")

    def __contains__(self, name: object) -> bool:
        return str(name) in list(self) if isinstance(name, (str, Expression)) else False

    def __iter__(self) -> Iterator[str]:
        return (one["name"] for one in self._parts())

    def __len__(self) -> int:
        return len(self._parts())

    # The values at once, which is quicker than one by one.
    def items(self) -> Any:
        return dict(zip(self, self._numbers())).items()

    def values(self) -> Any:
        return dict(self.items()).values()

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __setattr__(self, name: str, value: Any) -> None:
        self[name] = value

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self]

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (self._model,)

    @property
    def units(self) -> Dict[str, str]:
        """Units by name; empty texts where none is given."""
        return {one["name"]: one["unit"] for one in self._parts()}

    @property
    def texts(self) -> Dict[str, str]:
        """Meanings by name."""
        return {one["name"]: one["text"] for one in self._parts()}

    def __repr__(self) -> str:
        units = self.units
        return "{" + ", ".join(_with_unit(name, value, units[name]) for name, value in self.items()) + "}"

    def _repr_html_(self) -> str:
        return html_table(("name", "value", "unit", ""), self._rows())

    def _rows(self) -> List[Tuple[str, str, str, str]]:
        return [(part["name"], f"{value:.7g}", part["unit"], part["text"] + self._more(part))
                for part, value in zip(self._parts(), self._numbers())]

    def _more(self, part: Dict[str, Any]) -> str:
        return ""


class Parameters(_Values):
    """The parameters of a model: a mapping from names to values, which are attributes too.

    Independent parameters can be set, to numbers or to expressions in parameters, as texts too; those that follow from
    others change with them. `units` and `texts` are dicts by name. Raises ModelError for unknown names and for what is
    no finite number.

    >>> parameters = Model.shipped("impact-oscillator").parameters
    >>> parameters.omega = "2*pi/2.5"
    >>> parameters["omega"]
    2.5132741228718345
    """

    _kind = "parameter"
    _set = "set_parameter"

    def _parts(self) -> List[Dict[str, Any]]:
        return self._model._core.parameters

    def _numbers(self) -> List[float]:
        return self._model._core.parameter_values()

    @property
    def independent(self) -> Tuple[str, ...]:
        """Names of the parameters that do not follow from others."""
        return tuple(self._model._core.independent_parameters())

    @property
    def expressions(self) -> Dict[str, str]:
        """For each parameter that follows from others: how, as a text."""
        return {one["name"]: one["expression"] for one in self._parts() if one["expression"] is not None}

    def _more(self, part: Dict[str, Any]) -> str:
        return "" if part["expression"] is None else f" (= {part['expression']})"


class Initial(_Values):
    """The initial values of a model's states: a mapping from names to values, which are attributes too and can be set,
    to numbers or to expressions in parameters. `units` and `texts` are dicts by name.

    >>> model = Model.shipped("bouncing-ball")
    >>> model.initial.v = 0
    """

    _kind = "state"
    _set = "set_initial"

    def _parts(self) -> List[Dict[str, Any]]:
        return self._model._core.states

    def _numbers(self) -> List[float]:
        return self._model._core.initial_state()

    def _more(self, part: Dict[str, Any]) -> str:
        if part["period"] is not None:
            return f" (cyclic, period {part['period']})"
        return " (drifting)" if part["drifting"] else ""


def _with_unit(name: str, value: float, unit: str) -> str:
    return f"{name}: {value:.7g}" + (f" {unit}" if unit else "")


def html_table(heads: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    def row(tag: str, cells: Iterable[Any]) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"

    return (f"<table><thead>{row('th', heads)}</thead><tbody>" + "".join(row("td", cells) for cells in rows)
            + "</tbody></table>")
