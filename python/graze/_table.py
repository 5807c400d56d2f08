"""Tables: named columns of numbers or texts."""

from __future__ import annotations

import html
from collections.abc import Mapping
from operator import index
from typing import Any, Dict, Iterable, Iterator, List, Sequence, Tuple

from ._arguments import wrong
from ._attributes import Fixed
from ._errors import InputError, WrongType

_SHOWN = 10  # rows at either end, in notebooks


class Table(Fixed, Mapping):  # type: ignore[type-arg]
    """Named columns of equal length.

    Numbers are numpy arrays (NaN where one is missing), texts are lists (None where one is missing). `table["x"]` is a
    column, `table.x` too where the name is an identifier and no method; `len(table)` is the number of rows, `table.units`
    a dict of the units that are known, `table.columns` the names. A column that is kept lives on without the table. Arrays
    can be read only: copy them to change them, `x = table["x"].copy()`.

    `table[2:5]` and `table[table.x > 0]` are tables of some of the rows; `records()` goes through the rows.
    """

    units: Dict[str, str]

    def __init__(self, names: Iterable[str], columns: Iterable[Any], units: Sequence[str] = ()) -> None:
        distinct = _distinct(names)
        self._columns: Dict[str, Any] = dict(zip(distinct, map(_protected, columns)))
        self.units = {name: unit for name, unit in zip(distinct, units) if unit}
        counts = {len(column) for column in self._columns.values()}
        if len(counts) > 1:
            raise InputError("the columns are of different lengths", "give columns of equal length")

    def __getitem__(self, name: Any) -> Any:
        if isinstance(name, slice) or (not isinstance(name, str) and hasattr(name, "__len__")):
            return self.rows(name)
        try:
            return self._columns[name]
        except KeyError:
            known = ", ".join(map(str, self._columns))
            raise KeyError(f"there is no column {name!r}; the columns are {known}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(next(iter(self._columns.values()), ()))

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name in self._columns

    # A mapping's keys and values are its columns, but its length is the number of rows, and an empty table is false.
    def keys(self) -> Any:
        """The names of the columns, as those of a dict."""
        return self._columns.keys()

    def values(self) -> Any:
        """The columns, as those of a dict."""
        return self._columns.values()

    def items(self) -> Any:
        """Names and columns, as those of a dict."""
        return self._columns.items()

    @property
    def columns(self) -> Tuple[str, ...]:
        """The names of the columns."""
        return tuple(self._columns)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name == "_columns":
            raise AttributeError(name)
        try:
            return self._columns[name]
        except KeyError:
            raise AttributeError(f"the table has no column {name!r}") from None

    def _instead(self, name: str) -> str:
        return "tables are not changed: make a DataFrame of it by to_pandas()"

    def __reduce__(self) -> Tuple[Any, ...]:
        return Table, (list(self), list(self.values()), [self.units.get(name, "") for name in self])

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *(name for name in self._columns if name.isidentifier())]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Table):
            return NotImplemented
        return (list(self) == list(other) and self.units == other.units
                and all(_equal(one, another) for one, another in zip(self.values(), other.values())))

    __hash__ = None  # type: ignore[assignment]

    @property
    def array(self) -> Any:
        """The rows as a structured numpy array, which is a copy; texts are objects."""
        import numpy

        kinds = [
            (name, object if isinstance(column, list) else column.dtype) for name, column in self._columns.items()
        ]
        result = numpy.empty(len(self), dtype=kinds)
        for name, column in self._columns.items():
            result[name] = column
        return result

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        if copy is False:
            raise ValueError("the array of a table is always a copy")
        return self.array if dtype is None else self.array.astype(dtype)

    def rows(self, chosen: Any) -> Table:
        """The rows that truths, indices or a slice choose. Numbers chosen by a slice are views, not copies. InputError for
        truths that are not as many as there are rows, and for indices beyond them."""
        import numpy

        if not isinstance(chosen, slice):
            chosen = numpy.atleast_1d(numpy.asarray(chosen))
            if chosen.size == 0:
                chosen = chosen.astype(int)

        def of(column: Any) -> Any:
            if not isinstance(column, list):
                return column[chosen]
            if isinstance(chosen, slice):
                return column[chosen]
            texts = numpy.empty(len(column), dtype=object)
            texts[:] = column
            return list(texts[chosen])

        try:
            columns = [of(column) for column in self.values()]
        except IndexError as error:
            raise InputError(f"rows cannot be chosen so: {error}",
                             f"give a slice, {len(self)} truths, or indices below {len(self)}") from None
        return Table(self._columns, columns, [self.units.get(name, "") for name in self])

    def record(self, number: int) -> Dict[str, Any]:
        """One row, counted from 0, or from -1 backwards: a dict of Python's numbers and texts. IndexError where there is
        none."""
        try:
            row = range(len(self))[index(number)]
        except TypeError:
            raise wrong(number, "number", "is no number of a row", f"give one below {len(self)}", WrongType) from None
        except IndexError:
            raise IndexError(f"there is no row {number}; there are {len(self)}") from None
        return {name: _plain(column[row]) for name, column in self._columns.items()}

    def records(self) -> Iterator[Dict[str, Any]]:
        """The rows one after the other, each a dict of Python's numbers and texts."""
        lists = [column if isinstance(column, list) else column.tolist() for column in self.values()]
        return (dict(zip(self._columns, row)) for row in zip(*lists))

    def to_pandas(self) -> Any:
        """The table as a pandas DataFrame; units are in its `attrs["units"]`. Needs pandas."""
        import pandas

        frame = pandas.DataFrame(dict(self._columns))
        frame.attrs["units"] = dict(self.units)
        return frame

    def to_xarray(self) -> Any:
        """The table as an xarray Dataset along the dimension `row`; units are attributes of the variables. Needs xarray."""
        import numpy
        import xarray

        variables = {
            name: ("row", numpy.array(column, dtype=object if isinstance(column, list) else None),
                   {"units": self.units[name]} if name in self.units else {})
            for name, column in self._columns.items()
        }
        return xarray.Dataset(variables)

    def __repr__(self) -> str:
        names = list(self._columns)
        shown = ", ".join(names) if len(names) <= 12 else ", ".join([*names[:11], f"and {len(names) - 11} more"])
        return f"<Table of {len(self)} {'row' if len(self) == 1 else 'rows'}: {shown}>"

    def _repr_html_(self) -> str:
        total = len(self)
        rows = [*range(total)] if total <= 2 * _SHOWN else [*range(_SHOWN), None, *range(total - _SHOWN, total)]
        head = "".join(
            f"<th>{html.escape(str(name))}<br><small>{html.escape(self.units.get(name, ''))}</small></th>"
            for name in self._columns
        )
        lines = []
        for row in rows:
            cells = ("&#8942;" if row is None else _cell(_plain(column[row])) for column in self.values())
            lines.append("<tr>" + "".join(f"<td>{one}</td>" for one in cells) + "</tr>")
        count = f"{total} {'row' if total == 1 else 'rows'}"
        return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(lines)}</tbody></table><p>{count}</p>"


def _protected(column: Any) -> Any:
    """The same column, for reading only: results are kept, and nobody is to change them for all."""
    if hasattr(column, "setflags"):
        column = column.view()
        column.setflags(write=False)
    return column


def _distinct(names: Iterable[str]) -> List[str]:
    """The names; one that another column has already gets a suffix, as in result files."""
    result: List[str] = []
    for name in names:
        distinct, number = name, 2
        while distinct in result:
            distinct, number = f"{name}_{number}", number + 1
        result.append(distinct)
    return result


def _equal(one: Any, another: Any) -> bool:
    import numpy

    if isinstance(one, list) or isinstance(another, list):
        return len(one) == len(another) and all(a == b for a, b in zip(one, another))
    return bool(numpy.array_equal(one, another, equal_nan=one.dtype.kind in "fc" and another.dtype.kind in "fc"))


def _plain(value: Any) -> Any:
    """A number of numpy as one of Python."""
    return value.item() if hasattr(value, "item") else value


def _cell(value: Any) -> str:
    if value is None or value != value:
        return ""
    return f"{value:.7g}" if isinstance(value, float) else html.escape(str(value))
