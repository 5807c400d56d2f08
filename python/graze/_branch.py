"""Runs that are sequences of orbits: branches, curves, ladders, single orbits, and equilibria."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Mapping, Optional

from ._arguments import a_dict, whole
from ._calls import computed
from ._computing import Ways
from ._errors import InputError
from ._expressions import is_plain
from ._model import Model
from ._point import NOTHING_FOLLOWED, Point
from ._progress import Progress, interruptible
from ._results import Results
from ._run import Run
from ._table import Table

if TYPE_CHECKING:
    import numpy


class Branch(Run):
    """A branch of periodic orbits, or of equilibria.

    `branch["GR1"]` and `branch[17]` are orbits of it, by label or by number (-1: the last one); iterating goes through the
    special points, which `special` lists; `orbits()` are all orbits, `points` their table, `multipliers` an array (of
    equilibria `eigenvalues`). A branch is followed further from its points: `branch["GR1"].switch()`, `branch["PD1"].double()`, `branch.at(omega=2.5)`.
    """

    kind = "continue"

    def __getitem__(self, point: Any) -> Any:
        if isinstance(point, slice):
            return self.orbits()[point]
        if not isinstance(point, str):
            point = str(self._number(point))
        elif not is_plain(point):
            raise KeyError(f"an orbit is named by its label or number, not by {point!r}")
        try:
            return self._points([self._store.read("orbit", self.name, point)])[0]
        except InputError as error:
            if error.file:  # the mistake is one of the file, as of a damaged one, not of the label
                raise
            raise KeyError(str(error)) from None

    def _number(self, point: Any) -> int:
        """The number of an orbit; negative ones count from the end."""
        try:
            number = whole(point, "point", -(10**30), 10**30)
        except InputError:
            raise KeyError(f"an orbit is named by its label or number, not by {point!r}") from None
        if number >= 0:
            return number
        if number < -len(self):
            raise KeyError(f"there is no orbit {number}: run '{self.name}' has {len(self)} orbits")
        return len(self) + number

    def _points(self, made: List[Dict[str, Any]]) -> List[Point]:
        record = self._record
        parameters = self._store.model_of(record["model"]).independent_parameters()
        monitors = [name for name, _ in record["values"]]
        return [Point(self, one, parameters, monitors) for one in made]

    @property
    def special(self) -> List[Point]:
        """The special points, in the order of the branch."""
        return self._points(self._store.read("orbits", self.name, special=True))

    def orbits(self) -> List[Point]:
        """All orbits, in the order of their numbers."""
        return self._points(self._store.read("orbits", self.name, special=False))

    def __iter__(self) -> Iterator[Point]:
        return iter(self.special)

    def __contains__(self, point: object) -> bool:
        try:
            self[point]
        except KeyError:
            return False
        return True

    def __len__(self) -> int:
        return int(self._store.read("count", self.name))

    @property
    def segments(self) -> Table:
        """A row for each segment of each orbit."""
        return self.table("segments")

    @property
    def samples(self) -> Table:
        """The same as `segments`: orbits have no samples."""
        return self.segments

    @property
    def _followed(self) -> List[str]:
        """Names of what varies: of a family its coordinate, then the parameters, those that are followed first."""
        import json

        names = [name for name, _ in self._record["coordinates"]]
        family = json.loads(self._record["settings"])["branch"].get("family")
        return names if family is None or self._record["kind"] == "curve" else [family or "period", *names]

    @property
    def parameter(self) -> str:
        """The name of the parameter that is followed, or of the conserved quantity along which a family is."""
        return self._followed[0]

    @property
    def multipliers(self) -> numpy.ndarray[Any, Any]:
        """Multipliers of all orbits: complex, orbits x multipliers, the largest first; NaN where one is not defined."""
        return self._multipliers("multipliers")

    @property
    def half_multipliers(self) -> numpy.ndarray[Any, Any]:
        """The same for the maps over half a period, of orbits that are their own symmetric images."""
        return self._multipliers("half_multipliers")

    @property
    def eigenvalues(self) -> numpy.ndarray[Any, Any]:
        """Eigenvalues of all equilibria: complex, per unit of time, equilibria x eigenvalues, the largest real part first;
        NaN for orbits with a period."""
        return self._multipliers("eigenvalues")

    def _multipliers(self, what: str) -> numpy.ndarray[Any, Any]:
        import numpy

        table = self.table(what)
        point = numpy.asarray(table["point"], dtype=int)
        position = numpy.asarray(table["position"], dtype=int)
        result = numpy.full((len(self), int(position.max(initial=-1)) + 1), complex("nan+nanj"))
        result.real[point, position] = table["real"]
        result.imag[point, position] = table["imaginary"]
        return result

    @interruptible()
    def at(self, value: Optional[Mapping[str, float]] = None, /, *, threads: Optional[int] = None,
           progress: Progress = None, **values: float) -> Orbit:
        """The orbit of the branch at exactly one value of a parameter: the nearest one, moved there: `at(omega=2.5)`, or
        `at({"omega": 2.5})`, as for a parameter that is called `threads`. RunFailed if no orbit is found there."""
        if value is not None:
            values = {**a_dict(value, "at()", '{"omega": 2.5}'), **values}
        if len(values) != 1:
            raise InputError(f"{len(values)} values are given", "give the value of one parameter: at(omega=2.5)")
        known = self._model.independent_parameters()
        for name in values:
            if name not in known:
                raise InputError(f"the model has no independent parameter {name!r}", f"it has {', '.join(known)}")
        return computed(Orbit, self, {"start": {"run": self, "at": values}}, "at()", Ways(threads, progress))

    def ends(self) -> Dict[str, str]:
        """Why each part of the branch ends."""
        return dict(self._store.read("summary", self.name)["ends"])

    def __repr__(self) -> str:
        name = self.name.replace("'", "''")
        labels = self.query(f"SELECT label FROM special_points WHERE run = '{name}' ORDER BY number")["label"]
        shown = " ".join(label for label in labels if not label.startswith("EP"))
        return f"<{type(self).__name__} {self.name} of {self._record['model_name']}: {len(self)} orbits; {shown}>"


class Orbit(Branch):
    """One periodic orbit; it has all attributes and methods of its only point."""

    kind = "orbit"

    def __init__(self, store: Results, name: str) -> None:
        super().__init__(store, name)
        self._only: Optional[Point] = None  # once the run is complete

    @property
    def point(self) -> Point:
        """The orbit as a point, as those of branches are. InputError where none was found."""
        if self._only is not None:
            return self._only
        if not len(self):
            raise InputError(f"run '{self.name}' has no orbit: {self.failure or 'it is ' + self.status}",
                             "resume() goes on" if self.status == "unfinished" else "begin nearer to one")
        point: Point = self[0]
        if self.status == "complete":
            self._only = point
        return point

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return getattr(self.point, name)
        except InputError as error:
            raise AttributeError(str(error)) from None

    @property
    def _followed(self) -> List[str]:
        return []

    @property
    def parameter(self) -> str:
        """Raises AttributeError: one orbit follows no parameter; `parameters` is a dict of the values of all."""
        raise AttributeError(NOTHING_FOLLOWED)

    @property
    def multipliers(self) -> numpy.ndarray[Any, Any]:
        """The multipliers: complex, the largest first."""
        return self.point.multipliers

    @property
    def half_multipliers(self) -> numpy.ndarray[Any, Any]:
        """Those of the map over half a period, of an orbit that is its own symmetric image."""
        return self.point.half_multipliers

    @property
    def eigenvalues(self) -> numpy.ndarray[Any, Any]:
        """The eigenvalues, where the orbit is an equilibrium: complex, the largest real part first; else empty."""
        return self.point.eigenvalues

    @property
    def model(self) -> Model:
        """See `Point.model`."""
        return self.point.model

    def motion(self, samples: int = 500, *, quantities: Any = ()) -> Table:
        """See `Point.motion`."""
        return self.point.motion(samples, quantities=quantities)

    def follow(self, **keys: Any) -> Branch:
        """See `Point.follow`."""
        return self.point.follow(**keys)

    def __repr__(self) -> str:
        return repr(self.point) if len(self) else f"<Orbit {self.name}: {self.status}>"


class Equilibria(Branch):
    """The equilibria that were found: all in a box of states, or the one near a state.

    `rest[0]` or `rest["EP1"]` is a Point, whose `starts[0]` are the states and whose `eigenvalues` decide stability;
    iterating goes through all, `eigenvalues` has those of all, and `ends()` tells, for each mode that was searched,
    whether it is proven that there are no others. `follow(rest[0], V=(0, 5))` goes along a branch.
    """

    kind = "equilibrium"

    @property
    def _followed(self) -> List[str]:
        return []

    @property
    def parameter(self) -> str:
        """Raises AttributeError: equilibria follow no parameter; `parameters` of each is a dict of the values of all."""
        raise AttributeError(NOTHING_FOLLOWED)

    def __repr__(self) -> str:
        stable = sum(bool(one.stable) for one in self)
        return f"<Equilibria {self.name} of {self._record['model_name']}: {len(self)}, {stable} stable>"


class Curve(Branch):
    """A curve of special points in two parameters."""

    kind = "curve"


class Ladder(Branch):
    """A sequence of grazings, each with one contact more."""

    kind = "ladder"


class Tori(Branch):
    """The tori of quasi-periodic motion that begin at a torus point. `points` has a row for each, with its
    `rotation_number`; the orbit of a point is one return of a motion on it, which does not close. Points `PL`, where
    intervals begin and end in which tori lock, are orbits of several returns, without a rotation number."""

    kind = "torus"
