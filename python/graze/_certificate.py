"""What certifies that the model would follow an orbit."""

from __future__ import annotations

import html
from typing import Any, Dict, Sequence

from ._attributes import Fixed
from ._table import Table


class Certificate(Fixed):
    """What certifies that the model would follow an orbit (`graze orbit --format json`).

    `signature`; `symmetry` (of a half orbit; otherwise empty); `admissible`, and `reason` why not. Tables, in which
    segments count from 1: `segments` (how the event of each is met at its end), `minima` (of event functions inside
    segments: how close other events come), `end_values` (of other event functions at the ends).
    """

    segments: Table
    minima: Table
    end_values: Table
    signature: str
    symmetry: str
    admissible: bool
    reason: str

    def __init__(self, made: Dict[str, Any]) -> None:
        self.signature = made["signature"]
        self.symmetry = made["symmetry"]
        self.admissible = made["admissible"]
        self.reason = made["reason"]
        self.segments = counted(*made["segments"])
        self.minima = counted(*made["minima"])
        self.end_values = counted(*made["end_values"])

    def __repr__(self) -> str:
        return f"<Certificate of {self.signature}: {'admissible' if self.admissible else self.reason or 'inadmissible'}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self.segments._repr_html_()}"


def counted(names: Sequence[str], columns: Sequence[Any], units: Sequence[str]) -> Table:
    """A table whose segments are whole numbers."""
    return Table(names, [column.astype(int) if name == "segment" else column for name, column in zip(names, columns)],
                 units)
