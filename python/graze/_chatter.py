"""Ladders of grazings, and the onset of chatter to which they lead."""

from __future__ import annotations

import html
from typing import Any, Dict, Optional

from ._attributes import Fixed
from ._table import Table


class Chatter(Fixed):
    """A ladder of grazings, each with one contact more, and the onset of chatter to which it leads, as `graze ladder`
    tells it.

    `table`: the grazings, with the value of `parameter`, the ratio `lambda` of successive distances, and the first flip
    and fold of the branch that leaves each. `limit` and `limit_error`: the onset of chatter from the motion itself;
    `extrapolated` and `extrapolated_error`: from the grazings alone; `ratio`: to which `lambda` goes; `restitution` at
    the limit. They are None where there is none, and `no_limit` says why. `ends`: why there are no further grazings.
    """

    table: Table
    parameter: str
    ends: str
    no_limit: str
    limit: Optional[float]
    limit_error: Optional[float]
    extrapolated: Optional[float]
    extrapolated_error: Optional[float]
    restitution: Optional[float]
    ratio: Optional[float]

    def __init__(self, made: Dict[str, Any]) -> None:
        self.table = Table(*made["table"])
        self.parameter = made["parameter"]
        self.ends = made["ends"]
        self.no_limit = made["no_limit"]
        self.limit = made["limit"]
        self.limit_error = made["limit_error"]
        self.extrapolated = made["extrapolated"]
        self.extrapolated_error = made["extrapolated_error"]
        self.restitution = made["restitution"]
        self.ratio = made["ratio"]

    def __getitem__(self, name: str) -> Any:
        return self.table[name]

    def __len__(self) -> int:
        return len(self.table)

    def to_pandas(self) -> Any:
        """The table as a pandas DataFrame."""
        return self.table.to_pandas()

    def __repr__(self) -> str:
        limit = f"{self.parameter} = {self.limit:.12g} +- {self.limit_error:.1g}" if self.limit is not None else "no limit"
        return f"<Chatter: {len(self)} grazing{'s' * (len(self) != 1)}, {limit}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self.table._repr_html_()}"
