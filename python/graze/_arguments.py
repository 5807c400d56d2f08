"""Checks of arguments. Each gives the value in the type that the compiled part takes, or raises an InputError whose place is
the name of the argument."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Iterable, List, Optional, Tuple, Type

from ._errors import FileError, InputError, WrongType
from ._expressions import NOT_PLAIN, Expression, is_number, is_plain, short

_MOST_NAMED = 30  # names that a message lists


def wrong(value: Any, name: str, what: str, remedy: str, kind: Type[InputError] = InputError) -> InputError:
    """The error that a value is not what is needed. what: as "is no number"."""
    return kind(f"{short(value)} {what}", remedy, name)


def near(name: Any, known: Iterable[Any]) -> str:
    """A remedy that names what was perhaps meant."""
    from difflib import get_close_matches

    names_known = [str(one) for one in known]
    found = get_close_matches(str(name), names_known, 1)
    if found:
        return f"did you mean '{found[0]}'?"
    more = f" and {len(names_known) - _MOST_NAMED} more" if len(names_known) > _MOST_NAMED else ""
    return f"known: {', '.join(names_known[:_MOST_NAMED])}{more}" if names_known else "there are none"


def number(value: Any, name: str, *, least: Optional[float] = None, above: Optional[float] = None,
           finite: bool = True) -> float:
    if not is_number(value):
        kind = InputError if isinstance(value, (str, bytes)) else WrongType
        raise wrong(value, name, "is no number", "give a number", kind)
    try:
        result = float(value)
    except OverflowError:
        raise wrong(value, name, "is too large", "give a smaller number") from None
    except (TypeError, ValueError):
        raise wrong(value, name, "is no number", "give a number", WrongType) from None
    if finite and not abs(result) < float("inf"):
        raise wrong(value, name, "is not finite", "give a finite number")
    if least is not None and not result >= least:
        raise wrong(value, name, "is too small", f"give a number from {least:g} on")
    if above is not None and not result > above:
        raise wrong(value, name, "is not positive" if above == 0 else "is too small", f"give a number above {above:g}")
    return result


def whole(value: Any, name: str, least: int = 1, most: int = 2**53) -> int:
    try:
        result = None if isinstance(value, bool) else int(value.__index__())
    except (AttributeError, TypeError):
        result = None
    if result is None or result < least:
        raise wrong(value, name, f"is no whole number from {least} on", f"give {least} or more")
    if result > most:
        raise wrong(value, name, "is too large", f"give {most} or less")
    return result


def numbers(values: Any, name: str) -> Any:
    """Numbers in any arrangement, as an array of numpy in double precision."""
    import numpy

    try:
        given = numpy.asarray(values)
    except ValueError:  # lists of different lengths
        given = numpy.asarray(None)
    if given.dtype.kind not in "iuf" and not (given.dtype.kind == "O" and all(map(is_number, given.flat))):
        raise wrong(values, name, "has other things than numbers", "give a number, or a list or an array of numbers",
                    WrongType)
    return given.astype(float)


def number_of_threads(threads: Optional[int]) -> int:
    """None: as many as the process may use."""
    return len(os.sched_getaffinity(0)) if threads is None else whole(threads, "threads", 1, 2**31 - 1)


def truth(value: Any, name: str) -> bool:
    try:
        if value == 0 or value == 1:
            return bool(value)
    except ValueError:  # arrays
        pass
    raise wrong(value, name, "is neither True nor False", "give one of them")


def text(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise wrong(value, name, "is no text", "give a text", WrongType)
    if not is_plain(value):
        raise wrong(value, name, *NOT_PLAIN)
    return value


def a_dict(value: Any, name: str, example: str) -> Mapping[Any, Any]:
    """A mapping. example: of one, for the remedy."""
    if not isinstance(value, Mapping):
        raise wrong(value, name, "is no dict", f"give a dict, as {example}", WrongType)
    return value


def is_expression(value: Any) -> bool:
    return isinstance(value, (str, Expression))


def names(values: Any, name: str) -> List[str]:
    """One name or expression, or several."""
    if is_expression(values):
        return [text(str(values), name)]
    try:
        listed = None if isinstance(values, (bytes, Mapping)) else list(values)
    except TypeError:
        listed = None
    if listed is None or not all(map(is_expression, listed)):
        raise wrong(values, name, "is neither a text nor a list of texts", "give a name, or a list of names", WrongType)
    return [text(str(one), name) for one in listed]


def optional_name(value: Any, name: str) -> str:
    """A name that may be left out: empty then."""
    if value is None:
        return ""
    if not is_expression(value) or not str(value):
        raise wrong(value, name, "is no name", "give a name", WrongType)
    return text(str(value), name)


def expression(value: Any, name: str) -> str:
    """A number, or an expression in parameters, as a text that the library reads."""
    if not is_expression(value):
        return repr(number(value, name))
    if not str(value).strip():
        raise wrong(value, name, "is no number", "give a number")
    return text(str(value), name)


def expressions(values: Any, name: str) -> List[str]:
    """One number, several, or a text of several, in which FIRST:LAST stands for one number in each decade."""
    if isinstance(values, str):
        values = [part for part in (one.strip() for one in values.split(",")) if part]
    elif isinstance(values, Mapping) or not hasattr(values, "__iter__"):
        values = [values]
    return [expression(one, name) for one in values]


def settings(values: Any) -> List[Tuple[str, float]]:
    """Values of parameters, the argument `set`."""
    given = a_dict(values, "set", '{"omega": 2.5}')
    return [(text(str(name), "set"), number(value, f"set, {name}")) for name, value in given.items()]


def path_of(path: Any, what: str, name: str = "", remedy: str = "") -> str:
    """The path of a file or folder as a text. what: as "a file", for messages; name: of the argument."""
    try:
        result = os.fsdecode(path)
    except (TypeError, UnicodeError):
        raise wrong(path, name, "is no path", remedy or f"name {what} by a text or a path", WrongType) from None
    if not result or "\0" in result:
        raise FileError(f"{short(result)} is no name of {what}", remedy or "give another name", name)
    if not is_plain(result):  # as a path of bytes may be too
        raise wrong(path, name, *NOT_PLAIN, FileError)
    return result
