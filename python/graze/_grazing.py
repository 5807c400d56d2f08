"""What a grazing leads to: the verdict, and the map of a cycle from touch to touch."""

from __future__ import annotations

import html
import re
from typing import Any, Dict, Iterable, List, NamedTuple, NoReturn, Optional

from . import _arguments as checked
from ._attributes import Fixed
from ._errors import OrderError
from ._facts import Facts
from ._table import Table


class CycleMap:
    """The map of a cycle from touch to touch, to leading order: with x the differences of the active states from the
    orbit without contact, of which C is the clearance,

        x -> P (x + B s),   s = sqrt(-2 a h) where h = C + g x is negative, and 0 elsewhere

    (or B (-h)^(3/2), B (-h) or B h^2 in place of B s, as `order` says).

    Attributes: `order` ("square-root", "three-halves", "linear", "quadratic"); `active`, the names of the active
    states; `matrix` (P), `impact` (B), `gradient` (g), `acceleration` (a), `restitution`; `scales` of the active
    states; `state`, all states at the touch; `multipliers`, the largest first; `clearance_rate`, the derivative of C by
    the parameter (or None), and `steady`, that of x; `time` of a cycle, `half` whether it is half an orbit.
    """

    def __init__(self, core: Any, active: List[str]) -> None:
        self._core, self.active = core, tuple(active)
        self.order: str = core.order
        self.matrix, self.impact, self.gradient = core.matrix, core.impact, core.gradient
        self.acceleration, self.restitution = core.acceleration, core.restitution
        self.scales, self.state, self.steady = core.scales, core.state, core.steady
        self.multipliers = core.multipliers
        self.clearance_rate: Optional[float] = core.clearance_rate
        self.time: float = core.time
        self.half: bool = core.half

    def __getstate__(self) -> NoReturn:
        raise OrderError("a map cannot be copied or stored", "ask the point for it again: point.grazing().cycle_map")

    def projections(self, count: int) -> Any:
        """The effect of a contact on the clearance 1, 2, ..., count cycles later, per unit of its approach speed:
        g P^k B."""
        return self._core.projections(checked.whole(count, "count"))

    def image(self, state: Iterable[float], clearance: float) -> Any:
        """The active states after one cycle, with the next order where it is known. Raises InputError for a wrong number
        of states."""
        return self._core.image([checked.number(one, "state") for one in state], checked.number(clearance, "clearance"))

    def motion(self, clearance: float, *, transient: int = 2000, cycles: int = 2000) -> "MapMotion":
        """What the map settles on at a negative clearance of the orbit without contact, after so many cycles of
        transient, examined for so many `cycles`."""
        clearance, transient = checked.number(clearance, "clearance"), checked.whole(transient, "transient", 0)
        return MapMotion(*self._core.motion(clearance, transient, checked.whole(cycles, "cycles")))

    def __repr__(self) -> str:
        return f"<CycleMap ({self.order}) of {', '.join(self.active)}>"


class MapMotion(NamedTuple):
    """What the map of a cycle settles on."""

    period: int  #: in cycles; 0: it does not repeat
    contacts: int  #: in one period, or in all cycles that were examined
    largest: float  #: largest approach speed; of a compliant contact largest depth
    bounded: bool


class Grazing(Fixed, Facts):
    """What an orbit that touches leads to, as `graze grazing` tells it.

    A mapping from names of facts to their values: `grazing["verdict"]`, or `grazing.verdict`, is "lost", "persists",
    "folds" or "undecided" (`reason` says why). `facts` is the table of all, with their meanings: the acceleration, the
    restitution, the projections, growth of contacts, ... Facts that do not apply are not in it.
    `projections` is an array of the facts projection_1, projection_2, ...; `cycle_map` the map itself (None where there
    is none); `trial_motions` the table of the motions simulated to check the verdict (empty without `verify`).
    """

    point: str
    facts: Table
    reason: str
    trial_motions: Table
    projections: Any
    cycle_map: Optional[CycleMap]

    def __init__(self, point: str, made: Dict[str, Any]) -> None:
        import numpy

        self.point = point
        self.facts, self.reason = Table(*made["facts"]), made["reason"]
        self.trial_motions = Table(*made["trial_motions"])
        super().__init__(self.facts["quantity"], self.facts["value"])
        names = [name for name in self if re.fullmatch(r"projection_\d+", name)]
        self.projections = numpy.array([self[name] for name in names], dtype=float)
        self.cycle_map = CycleMap(made["map"], made["active"]) if made["map"].exists else None

    def __getstate__(self) -> Dict[str, Any]:
        return {**vars(self), "cycle_map": None}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._values[name]
        except KeyError:
            raise AttributeError(f"no fact {name!r} applies to this touch; there are {', '.join(self._values)}") from None

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self._values]

    def to_pandas(self) -> Any:
        """The facts as a pandas DataFrame."""
        return self.facts.to_pandas()

    def __repr__(self) -> str:
        more = f" ({self.reason})" if self.reason else ""
        return f"<Grazing at {self.point}: {self._values.get('verdict', 'no verdict')}{more}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self.facts._repr_html_()}"
