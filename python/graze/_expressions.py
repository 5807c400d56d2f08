"""Expressions in states and parameters, made by operators and functions of Python."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any, List, TYPE_CHECKING, Union

from . import _graze
from ._errors import InputError

if TYPE_CHECKING:
    class Expression:
        """See below."""

        def __init__(self, name: str) -> None: ...
        def __add__(self, other: Operand) -> Expression: ...
        def __radd__(self, other: Operand) -> Expression: ...
        def __sub__(self, other: Operand) -> Expression: ...
        def __rsub__(self, other: Operand) -> Expression: ...
        def __mul__(self, other: Operand) -> Expression: ...
        def __rmul__(self, other: Operand) -> Expression: ...
        def __truediv__(self, other: Operand) -> Expression: ...
        def __rtruediv__(self, other: Operand) -> Expression: ...
        def __pow__(self, other: Operand) -> Expression: ...
        def __rpow__(self, other: Operand) -> Expression: ...
        def __neg__(self) -> Expression: ...
        def __pos__(self) -> Expression: ...
        def __gt__(self, other: Operand) -> Condition: ...
        def __ge__(self, other: Operand) -> Condition: ...
        def __lt__(self, other: Operand) -> Condition: ...
        def __le__(self, other: Operand) -> Condition: ...
        def __float__(self) -> float: ...
        def derivative(self, by: Union[Expression, str]) -> Expression: ...
        def substitute(self, values: Any = None, **named: Any) -> Expression: ...
        @property
        def symbols(self) -> List[str]: ...
        @property
        def _number(self) -> Any: ...
        @property
        def _is_symbol(self) -> bool: ...
        @property
        def _tables(self) -> List[Any]: ...
else:
    Expression = _graze.Expression

Operand = Union["Expression", float]
Expression.__module__ = "graze"
Expression.__doc__ = """An expression in named symbols: states, parameters, definitions.

Made from `states`, `parameters` or `symbols` by `+ - * / **`, the functions `sin`, `exp`, ... of this package, numpy's
functions of the same names, and from text by `expression`. Comparisons by `< <= > >=` give conditions of transitions.
Expressions are equal if they differ only in the order of sums and products; they can be keys of dicts. `symbols` has
the names that occur.

`Expression(name)` is a symbol. Raises InputError for operations that are not analytic, such as abs and %, and for what
is no number.
"""


NOT_PLAIN = "has parts of characters that are no characters", "leave them out"
"""What is wrong with a text that UTF-8 cannot say, and what to do."""


def is_plain(text: str) -> bool:
    """Whether UTF-8 can say the text."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def plain(text: Any) -> str:
    """The text of an object. Raises InputError if UTF-8 cannot say it."""
    text = str(text)
    if not is_plain(text):
        raise InputError(f"{short(text)} {NOT_PLAIN[0]}", NOT_PLAIN[1])
    return text


def is_number(value: Any) -> bool:
    """Whether a value stands for one real number, as those of Python and numpy and fractions do."""
    if isinstance(value, (bool, complex, str, Expression)):
        return False
    return hasattr(value, "__float__") and getattr(value, "ndim", None) in (None, 0)


def number_of(value: Any) -> float:
    """What such a value is in double precision. Raises InputError if it is too large."""
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{short(value)} is no number of double precision", "give another one") from None


def short(value: Any) -> str:
    """What messages show of a value."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


class Condition:
    """One or several comparisons, all of which hold: `(x > 0) & (v <= 1)`. `text` is what a model file says."""

    __slots__ = ("text", "tables")

    def __init__(self, text: str, tables: Any = ()) -> None:
        self.text = text
        self.tables = list(tables)

    def __and__(self, other: "Condition") -> "Condition":
        if not isinstance(other, Condition):
            return NotImplemented
        return Condition(f"{self.text} and {other.text}", self.tables + other.tables)

    def __or__(self, other):
        raise InputError("conditions cannot be joined by `|`",
                         "list the mode once more among the alternatives of `next`, with the other condition")

    __ror__ = __or__

    def __invert__(self):
        raise InputError("a condition cannot be negated", "turn the comparison round: `a <= b` for `~(a > b)`")

    def __bool__(self):
        raise InputError("a condition of expressions is neither true nor false by itself",
                         "join conditions by & (not by `and`, nor as `a < b < c`), and give them to a transition")

    def __eq__(self, other):
        return self.text == other.text if isinstance(other, Condition) else NotImplemented

    def __hash__(self):
        return hash(self.text)

    def __reduce__(self):
        return _condition_again, (self.text, [table.parts for table in self.tables])

    def __repr__(self):
        return self.text


def _operand(value):
    """The text of an operand of a comparison; None: it is none."""
    if isinstance(value, Expression):
        return str(value)
    return str(_graze.number(number_of(value))) if is_number(value) else None


def _comparison(sign):
    def compare(self, other):
        text = _operand(other)
        if text is None:
            return NotImplemented
        return Condition(f"{self} {sign} {text}", [table for one in (self, other) for table in getattr(one, "_tables", [])])

    return compare


def _refusal(written: str):
    """A method that raises what the library says of a function or sign that expressions cannot have."""

    def refuse(self, *others, **more):
        try:
            _graze.parsed_expression(written, [])
        except InputError as error:
            raise InputError(error.problem, error.remedy) from None
        raise InputError(f"'{written}' is no operation on expressions", "")

    return refuse


def _no_exclusive_or(self, other):
    raise InputError("'^' is no power in Python", "write ** between base and exponent")


def _new(cls, name, *others, **fields):
    """Makes it whole at once: an object of the compiled part must not exist without its contents."""
    if not isinstance(name, str):
        raise InputError(f"{short(name)} cannot be a name", "give the name as a text")
    name = plain(name)
    made = _BASE.__new__(cls)
    _init(made, name)
    return made


class _Signature:
    """How a class is called is said by its `__init__`, though it has a `__new__`."""

    def __get__(self, one, kind):
        import inspect

        if kind is Expression:
            name = inspect.Parameter("name", inspect.Parameter.POSITIONAL_OR_KEYWORD, annotation=str)
            return inspect.Signature([name])
        of_init = inspect.signature(kind.__init__)
        return of_init.replace(parameters=list(of_init.parameters.values())[1:])


def _float(self) -> float:
    if self._number is not None:
        return self._number
    names = self.symbols
    if names:
        raise InputError(f"the expression {short(self)} is no number: it depends on {', '.join(names)}",
                         "functions of expressions are graze.sin, numpy.sin, ... (not math.sin); "
                         "values of symbols are given by substitute()")
    raise InputError(f"the expression {short(self)} has no finite value", "look for a division by zero")


def _derivative(self, by):
    """The derivative with respect to a symbol, or to a name.

    >>> x = symbols("x")
    >>> (x**3).derivative(x)
    3*x^2
    """
    return self._derivative(by if isinstance(by, Expression) else _graze.symbol(plain(by)))


def _substitute(self, values=None, **named):
    """The expression with numbers or expressions in the place of symbols, all at once; `float` makes a number of one
    without symbols.

    values: a dict of symbols or names; further ones by keyword.

    >>> x, v = symbols("x v")
    >>> float((x**2 + v).substitute(x=3, v=0.5))
    9.5
    """
    values = {} if values is None else values
    if not isinstance(values, Mapping):
        raise InputError(f"{short(values)} is no dict", "give a dict from symbols or names to values")
    by_name = {}
    for symbol, value in {**values, **named}.items():
        if isinstance(symbol, Expression) and not symbol._is_symbol:
            raise InputError(f"{symbol} is no symbol", "substitute for single symbols")
        by_name[plain(symbol)] = expression(value)
    return self._substituted(list(by_name.items()))


_BASE, _init = _graze.Expression.__base__, _graze.Expression.__init__
for _name, _method in {
        "__new__": _new, "__signature__": _Signature(),
        "__gt__": _comparison(">"), "__ge__": _comparison(">="), "__lt__": _comparison("<"), "__le__": _comparison("<="), "__xor__": _no_exclusive_or, "__rxor__": _no_exclusive_or, "__float__": _float,
        "__repr__": lambda self: str(self), "__reduce__": lambda self: (_made_again, (str(self), [table.parts for table in self._tables])),
        "derivative": _derivative, "substitute": _substitute,
        "__array_priority__": -1,  # numpy's numbers leave operations to expressions, its arrays do not
}.items():
    setattr(Expression, _name, _method)
# The last are methods that numpy's functions of these names call.
for _name, _written in {
        "__abs__": "abs(1)", "__mod__": "mod(1)", "__rmod__": "mod(1)", "__divmod__": "mod(1)", "__rdivmod__": "mod(1)",
        "__floordiv__": "floor(1)", "__rfloordiv__": "floor(1)", "__floor__": "floor(1)", "__ceil__": "ceil(1)",
        "__round__": "round(1)", "__trunc__": "trunc(1)", "floor": "floor(1)", "ceil": "ceil(1)", "rint": "round(1)",
        "trunc": "trunc(1)", "fabs": "fabs(1)", "arctan2": "atan2(1, 1)", "log10": "log10(1)", "log2": "log2(1)",
        "log1p": "log1p(1)", "expm1": "expm1(1)", "exp2": "exp2(1)", "cbrt": "cbrt(1)", "hypot": "hypot(1, 1)",
        "arcsinh": "arcsinh(1)", "arccosh": "arccosh(1)", "arctanh": "arctanh(1)"}.items():
    setattr(Expression, _name, _refusal(_written))
del _name, _method, _written


def _tables_again(all_parts):
    return [_graze.PieceTable(*parts) for parts in all_parts]


def _condition_again(text, tables):
    return Condition(text, _tables_again(tables))


def _made_again(text, tables):
    return _graze.parsed_expression(text, list(_names_in(text)), _tables_again(tables))


def _names_in(text):
    """The names that a text uses, each once, in their order."""
    return dict.fromkeys(word for word in _WORD.findall(text) if word != "pi")


_WORD = re.compile(r"(?<![\w.])[A-Za-z_][A-Za-z0-9_]*(?![\w(])(?!\s*\()", re.ASCII)


def expression(text: Any, *names: str) -> Expression:
    """The expression that a text says, in the given names; in any names if none are given. Numbers become expressions,
    and expressions stay what they are.

    Raises InputError, with line and column, for what docs/expressions.md does not allow.
    """
    if isinstance(text, Expression):
        return text
    if not isinstance(text, str):
        if not is_number(text):
            raise InputError(f"{short(text)} is no expression", "give a text or a number")
        return _graze.number(number_of(text))
    text = plain(text)
    known = dict.fromkeys(map(plain, names)) if names else _names_in(text)
    for name in known:
        _graze.symbol(name)  # raises for what is no name
    return _graze.parsed_expression(text, list(known))


def symbols(names: str) -> Any:
    """Symbols by their names, separated by blanks or commas: one, or a tuple of several.

    >>> x, v = symbols("x v")
    >>> x**2 + 2*v
    x^2 + 2*v
    """
    made = tuple(_graze.symbol(word) for word in words_of(names, "symbols"))
    return made[0] if len(made) == 1 else made


def words_of(names: Any, called: str) -> list:
    """Names that are separated by blanks or commas."""
    if not isinstance(names, str):
        raise InputError(f"{short(names)} are no names", f'give them in one text, as in {called}("x v")')
    words = plain(names).replace(",", " ").split()
    if not words:
        raise InputError("no names are given", f'name them, as in {called}("x v")')
    return words


def _function(name: str):
    def call(of: Any) -> Any:
        if isinstance(of, Expression):
            return getattr(of, name)()
        if not isinstance(of, str) and getattr(of, "ndim", 0):
            import numpy

            of_numpy = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}.get(name, name)
            if hasattr(numpy, of_numpy):
                return getattr(numpy, of_numpy)(of)
        try:
            return getattr(math, name)(of)
        except (TypeError, ValueError, OverflowError) as error:
            raise InputError(f"{name}({short(of)}) is no number: {error}",
                             "give an expression, or a number for which it is defined") from None

    call.__name__ = call.__qualname__ = name
    call.__doc__ = f"The function `{name}` of an expression, which becomes an expression, or of a number."
    return call


sqrt, exp, log, sin, cos, tan, asin, acos, atan, sinh, cosh, tanh, erf = map(
    _function, "sqrt exp log sin cos tan asin acos atan sinh cosh tanh erf".split()
)
