"""One motion of a model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Iterable, List, Optional, Tuple, Union

from . import _arguments as checked, _graze
from ._attributes import Fixed
from ._errors import InputError
from ._model import Model
from ._table import Table

if TYPE_CHECKING:
    import numpy

    from ._simulation import Simulation


Names = Union[str, _graze.Expression, Iterable[Union[str, _graze.Expression]]]
"""One name or expression, or several."""


class Motion(Fixed):
    """A computed motion.

    `motion["x"]` (or `motion.x`) are the sampled values of a state or quantity at the times `motion.t`. Tables, with a
    row each: `samples`; `contacts` (states just before, and with `_after` just after each); `sections`, `extrema`,
    `minima`, `derivatives`: None where they were not asked for; `summary`, of one row.

    `ending` says how the motion ended ("end-time", "stopped": after as many periods or contacts as asked for,
    "terminal", "singular", "table-full", "interrupted", ...), `detail` why, `regular` whether as asked or by the nature
    of the system; `end_time`, `end_state` (a dict) and `end_mode` when and where; `steps` how many steps were made.

    Arrays can be read only: copy them to change them, `x = motion["x"].copy()`.
    Motions stay valid whatever becomes of model and simulation, and can be pickled.
    """

    ending: str
    regular: bool
    detail: str
    end_time: float
    end_mode: str
    steps: int

    def __init__(self, simulation: Simulation, asked: Dict[str, Any], made: Any) -> None:
        self._simulation, self._asked = simulation, asked
        self._core: Any = made
        self._tables: Dict[str, Optional[Table]] = {}
        self._steps: Any = None
        self.ending, self.regular, self.detail = made.ending, made.regular, made.detail
        self.end_time, self.end_mode, self.steps = made.time, made.mode, made.steps

    def _table(self, name: str) -> Optional[Table]:
        if name not in self._tables:
            made = self._core.table(name)
            self._tables[name] = None if made is None else Table(*made)
        return self._tables[name]

    def _needed(self, name: str) -> Table:
        table = self._table(name)
        assert table is not None
        return table

    @property
    def samples(self) -> Table:
        """The states, quantities and mode at equal distances or given times; without rows for `samples=0`."""
        table = self._table("samples")
        if table is None:
            import numpy

            units = [self.model.time_unit, "", *(one.unit for one in self.model.states)]
            names = ["time", "mode", *self.model.initial]
            table = Table(names, [[] if name == "mode" else numpy.empty(0) for name in names], units)
            self._tables["samples"] = table
        return table

    @property
    def contacts(self) -> Table:
        """The contacts: time, kind ("crossing", "touch", "sticking"), event, transition, modes before and after, rates
        of the event function before and after, then states and quantities just before, and just after ("_after")."""
        return self._needed("contacts")

    @property
    def sections(self) -> Optional[Table]:
        """The passages of sections: section, time, direction (1: rising, -1), mode, states and quantities."""
        return self._table("sections")

    @property
    def extrema(self) -> Optional[Table]:
        """The extrema of expressions: expression, time, kind, value, mode, whether at a contact, states."""
        return self._table("extrema")

    @property
    def minima(self) -> Optional[Table]:
        """The least value of each watched event function in each arc, with a guaranteed lower bound."""
        return self._table("minima")

    @property
    def derivatives(self) -> Optional[Table]:
        """The derivatives of the last state: state, value, and a column "d_NAME" for each direction. NaN where they do
        not exist, as after a contact without speed. Those by parameters hold the initial state."""
        return self._table("derivatives")

    @property
    def summary(self) -> Table:
        """One row: ending, its time, numbers of steps, contacts, touches and stickings, the last mode, the last values of
        states and quantities."""
        table = self._needed("summary")
        return Table(table, [[self.ending] if name == "ending" else column for name, column in table.items()],
                     [table.units.get(name, "") for name in table])

    @property
    def end_state(self) -> Dict[str, float]:
        """The last state, by name."""
        return dict(zip(self.model.initial, self._core.state))

    @property
    def model(self) -> Model:
        """The model as it was simulated (but for `set`, `state` and `mode`)."""
        return self._simulation.model

    @property
    def t(self) -> numpy.ndarray[Any, Any]:
        """The times of the samples."""
        return self.samples["time"]

    def __getitem__(self, name: str) -> Any:
        return self.samples[name]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name == "samples":
            raise AttributeError(name)
        return getattr(self.samples, name)

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *(name for name in self.samples if name.isidentifier())]

    def __call__(self, times: Any) -> numpy.ndarray[Any, Any]:
        """States at these times, along a further last axis; NaN outside of the motion. At the time of a contact: those
        just before it. Raises InputError unless the motion was simulated with `dense=True`."""
        if not self._asked.get("dense"):
            raise InputError("the steps of this motion were not kept", "simulate it with dense=True")
        if self._steps is None:
            self._steps = self._core.dense()
        asked = checked.numbers(times, "times")
        states = self._steps.at(asked.ravel())
        return states.reshape(*asked.shape, states.shape[-1])

    def plot(self, quantities: Names = (), portraits: Iterable[Tuple[Any, Any]] = (), *, axes: Any = None) -> Any:
        """Draws histories of quantities (the states), and portraits of pairs of quantities, with contacts marked: the
        motion is computed once more for this. Returns the axes of matplotlib, one or an array."""
        from ._plot import draw

        return draw(self._picture(quantities, portraits), axes)

    def figure(self, quantities: Names = (), portraits: Iterable[Tuple[Any, Any]] = ()) -> Any:
        """The data that `plot` draws."""
        from ._plot import Figure

        return Figure(self._picture(quantities, portraits))

    def _picture(self, quantities: Names = (), portraits: Iterable[Tuple[Any, Any]] = ()) -> Any:
        pairs = [tuple(checked.names(pair, "portraits")) for pair in portraits]
        if any(len(pair) != 2 for pair in pairs):
            raise InputError("a portrait has two quantities", 'give pairs, as in [("x", "v")]', "portraits")
        asked = {name: value for name, value in self._asked.items() if name not in ("dense", "at", "every", "samples")}
        if "at" in self._asked and not {"time", "periods", "contacts"} & set(asked):
            asked["time"] = self._asked["at"][-1]
        return self._simulation._core.figure(asked, checked.names(quantities, "quantities"), pairs)

    def to_pandas(self) -> Any:
        """The samples as a pandas DataFrame."""
        return self.samples.to_pandas()

    def to_xarray(self) -> Any:
        """The samples as an xarray Dataset along `time`."""
        data = self.samples.to_xarray()
        return data.set_coords("time").swap_dims(row="time")

    def __reduce__(self) -> Tuple[Any, ...]:
        names = ("samples", "contacts", "sections", "extrema", "minima", "derivatives", "summary")
        tables = {name: table for name in names if (table := self._table(name)) is not None}
        kept = {name: getattr(self._core, name) for name in ("ending", "regular", "detail", "time", "mode", "steps",
                                                             "state")}
        return _motion_again, (self._simulation, self._asked, kept, tables)

    def __repr__(self) -> str:
        return (f"<Motion of {self.model.name}: {len(self.samples)} samples, {len(self.contacts)} contacts, "
                f"ended at {self.end_time:.7g} ({self.ending})>")

    def _repr_html_(self) -> str:
        from ._plot import small_picture

        quick = 20_000  # steps, which are computed again for the picture
        return small_picture(lambda: self._picture() if self.steps <= quick else None, repr(self))


class _Kept:
    """What a motion that was pickled has instead of its compiled part. Its steps are computed once more."""

    def __init__(self, simulation: Simulation, asked: Dict[str, Any], kept: Dict[str, Any]) -> None:
        self.__dict__.update(kept)
        self._again = simulation._core, asked

    def table(self, name: str) -> None:
        """All tables that there are were restored."""

    def dense(self) -> Any:
        core, asked = self._again
        return core.run(asked, None).dense()


def _motion_again(simulation: Simulation, asked: Dict[str, Any], kept: Dict[str, Any],
                  tables: Dict[str, Optional[Table]]) -> Motion:
    motion = Motion(simulation, asked, _Kept(simulation, asked, kept))
    motion._tables.update(tables)
    return motion
