"""Tables: named columns of numbers or texts."""

from __future__ import annotations

import html
from collections.abc import Mapping


class Table(Mapping):
    """Named columns of equal length.

    Numbers are numpy arrays (NaN where one is missing), texts are lists. `table["x"]` is a column, `table.x` too where
    the name is an identifier; `len(table)` is the number of rows, `table.units` a dict of the units that are known.
    """

    def __init__(self, names, columns, units=()):
        self._columns = dict(zip(names, columns))
        self.units = {name: unit for name, unit in zip(names, units) if unit}

    def __getitem__(self, name):
        try:
            return self._columns[name]
        except KeyError:
            known = ", ".join(map(str, self._columns))
            raise KeyError(f"there is no column {name!r}; the columns are {known}") from None

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        return len(next(iter(self._columns.values()), ()))

    # A mapping's keys and values are its columns, but its length is the number of rows, and an empty table is false.
    def keys(self):
        return self._columns.keys()

    def values(self):
        return self._columns.values()

    def items(self):
        return self._columns.items()

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._columns[name]
        except KeyError:
            raise AttributeError(f"the table has no column {name!r}") from None

    def __dir__(self):
        return [*super().__dir__(), *(name for name in self._columns if name.isidentifier())]

    def __eq__(self, other):
        import numpy

        if not isinstance(other, Table):
            return NotImplemented
        return list(self) == list(other) and all(
            numpy.array_equal(one, another) if isinstance(one, list) or isinstance(another, list)
            else numpy.array_equal(one, another, equal_nan=True)
            for one, another in zip(self.values(), other.values())
        )

    __hash__ = None

    @property
    def array(self):
        """The rows as a structured numpy array; texts are objects."""
        import numpy

        kinds = [
            (name, object if isinstance(column, list) else column.dtype) for name, column in self._columns.items()
        ]
        result = numpy.empty(len(self), dtype=kinds)
        for name, column in self._columns.items():
            result[name] = column
        return result

    def rows(self, chosen) -> "Table":
        """The rows that a numpy array of truths or indices, or a slice, chooses."""
        import numpy

        def of(column):
            if isinstance(column, list):
                return list(numpy.asarray(column, dtype=object)[chosen])
            return column[chosen]

        return Table(self._columns, [of(column) for column in self.values()],
                     [self.units.get(name, "") for name in self])

    def to_pandas(self):
        """The table as a pandas DataFrame; units are in its `attrs["units"]`."""
        import pandas

        frame = pandas.DataFrame({name: column for name, column in self._columns.items()})
        frame.attrs["units"] = dict(self.units)
        return frame

    def to_xarray(self):
        """The table as an xarray Dataset along the dimension `row`; units are attributes of the variables."""
        import numpy
        import xarray

        variables = {
            name: ("row", numpy.asarray(column, dtype=object if isinstance(column, list) else None),
                   {"units": self.units[name]} if name in self.units else {})
            for name, column in self._columns.items()
        }
        return xarray.Dataset(variables)

    def __repr__(self):
        return f"<Table of {len(self)} rows: {', '.join(map(str, self._columns))}>"

    def _repr_html_(self):
        shown, total = 10, len(self)
        rows = list(range(total)) if total <= 2 * shown else [*range(shown), None, *range(total - shown, total)]

        def cell(value):
            if value is None or value != value:
                return ""
            return f"{value:.7g}" if isinstance(value, float) else html.escape(str(value))

        head = "".join(
            f"<th>{html.escape(str(name))}<br><small>{html.escape(self.units.get(name, ''))}</small></th>"
            for name in self._columns
        )
        lines = []
        for row in rows:
            cells = ("&#8942;" if row is None else cell(getattr(column[row], "item", lambda c=column, r=row: c[r])())
                     for column in self.values())
            lines.append("<tr>" + "".join(f"<td>{one}</td>" for one in cells) + "</tr>")
        return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(lines)}</tbody></table><p>{total} rows</p>"
