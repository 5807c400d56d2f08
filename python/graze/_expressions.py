"""Expressions in states and parameters, made by operators and functions of Python."""

from __future__ import annotations

import re
from typing import Tuple, Union

from . import _graze
from ._errors import InputError

Expression = _graze.Expression
Number = Union[int, float]


class Condition:
    """One or several comparisons, all of which hold: `(x > 0) & (v <= 1)`."""

    __slots__ = ("text",)

    def __init__(self, text: str):
        self.text = text

    def __and__(self, other: "Condition") -> "Condition":
        if not isinstance(other, Condition):
            return NotImplemented
        return Condition(f"{self.text} and {other.text}")

    def __bool__(self):
        raise InputError("a condition of expressions is neither true nor false by itself",
                         "join conditions by & (not by `and`), and give them to a transition")

    def __repr__(self):
        return self.text


def _comparison(sign):
    def compare(self, other):
        if not isinstance(other, (Expression, int, float)):
            return NotImplemented
        return Condition(f"{self} {sign} {other}")

    return compare


Expression.__gt__ = _comparison(">")
Expression.__ge__ = _comparison(">=")
Expression.__lt__ = _comparison("<")
Expression.__le__ = _comparison("<=")
Expression.__repr__ = lambda self: str(self)
Expression.__reduce__ = lambda self: (expression, (str(self), *self.symbols))


def expression(text: str, *names: str) -> Expression:
    """The expression that a text says, in the given names; in any names if none are given."""
    known = names or {word for word in re.findall(r"[A-Za-z_]\w*(?!\w|\s*\()", str(text)) if word != "pi"}
    return _graze.parsed_expression(str(text), sorted(known))


def symbols(names: str) -> Union[Expression, Tuple[Expression, ...]]:
    """Symbols by their names, separated by blanks or commas: one, or a tuple of several.

    >>> x, v = symbols("x v")
    >>> x**2 + 2*v
    x^2 + 2*v
    """
    words = names.replace(",", " ").split()
    if not words:
        raise InputError("no names are given", 'name them, as in symbols("x v")')
    made = tuple(_graze.symbol(word) for word in words)
    return made[0] if len(made) == 1 else made


def _function(name: str):
    import math

    def call(of):
        if isinstance(of, Expression):
            return getattr(of, name)()
        return getattr(math, name)(of)

    call.__name__ = call.__qualname__ = name
    call.__doc__ = f"The function `{name}` of an expression, which becomes an expression, or of a number."
    return call


sqrt, exp, log, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, erf = map(
    _function, "sqrt exp log sin cos tan asin acos atan sinh cosh tanh erf".split()
)
