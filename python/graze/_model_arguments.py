"""Arguments of `Model` that describe its parts: names, lists, dicts, and parts in any of their forms."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Dict, List

from ._arguments import near
from ._errors import ModelError
from ._expressions import Expression, short
from ._model_parts import Jump, Mode, Part, Symmetry


def mistake(label: str, problem: str, remedy: str = "") -> ModelError:
    return ModelError(problem, remedy, f"Model(), {label}" if label else "Model()")


def key_of(key: Any, label: str) -> str:
    """The name that a key of a dict, or an entry of a list, says."""
    if isinstance(key, Expression) and key._is_symbol:
        return str(key)
    if isinstance(key, str):
        return key
    raise mistake(label, f"{short(key)} is no name", "give a text, or a state, parameter or definition")


def a_dict(value: Any, label: str, example: str) -> Dict[str, Any]:
    if not isinstance(value, Mapping):
        raise mistake(label, f"{short(value)} is no dict", f"give {example}")
    result: Dict[str, Any] = {}
    for key, item in value.items():
        name = key_of(key, label)
        if name in result:
            raise mistake(label, f"'{name}' is given twice", "leave one of the two out")
        result[name] = item
    return result


def a_list(value: Any, label: str) -> List[Any]:
    if not isinstance(value, (str, Mapping, Expression)):
        try:
            return list(value)
        except TypeError:
            pass
    raise mistake(label, f"{short(value)} is no list", "give a list")


def part_of(kind: Any, value: Any, label: str, *, by_first: bool = True) -> Any:
    """A part that is given as such, as a dict of its fields, or (by_first) as its first field only."""
    if isinstance(value, kind):
        return value
    code = kind.__init__.__code__
    names = code.co_varnames[1:code.co_argcount + code.co_kwonlyargcount]
    fields = isinstance(value, Mapping)
    if fields and kind in (Mode, Jump, Symmetry):  # whose first field is a dict
        fields = names[0] in value or (kind is Symmetry and "modes" in value)
    if fields:
        for key in value:
            if key not in names:
                raise mistake(label, f"{kind._what} has no '{key}'", near(key, names))
        for name in names[:code.co_argcount - 1 - len(kind.__init__.__defaults__ or ())]:
            if name not in value:
                raise mistake(label, f"{kind._what} needs '{name}'", f"give it, or a graze.{kind.__name__}")
        return kind(**value)
    if by_first and value is not None and not isinstance(value, Part):
        return kind(value)
    raise mistake(label, f"{short(value)} is not {kind._what}", f"give a graze.{kind.__name__}")
