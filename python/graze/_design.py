"""Switches designed from a list of wishes."""

from __future__ import annotations

import os
from typing import Any, Callable, Dict, List, Optional, Tuple

from . import _arguments as checked, _graze
from ._attributes import Fixed
from ._design_text import DesignText
from ._errors import InputError, OrderError
from ._facts import Facts
from ._model import Model
from ._output import Replacement, empty_folder, write_file
from ._progress import Progress, attended, interruptible
from ._results import StoredFile
from ._study import Study
from ._table import Table


class Design(Fixed, Facts):
    """A designed switch: the device, and what is known about it.

    A mapping from the quantities of `facts` to their values: `found["trip_value"]`. Attributes:

    `name`, `control` (the parameter that drives the device); `trip_value`; `outcome`, the class of the trip point
    ("trips", "persists", "folds" or "undecided"), with `outcome_reason`; `reset_value` (None: there is none);
    `dimensions`, a dict of their values; `wishes` ("met", "unmet", "unfinished", "nowhere"; empty: nothing was wanted), and
    `wants`, a table of them; `warnings`, a list of texts, and `regular`, which is True where there are none; `problems`, a
    dict of what is wrong with devices of the yield, and with how many.

    Tables: `facts`, `sensitivities`, `earlier` (points on the way to the trip point), `trip_times`, `tuning` and
    `devices` (None where they were not asked for); `curves`, a dict of dimensions, and `planes`, a dict of pairs of
    dimensions. `tables` is a dict of all, by the names of the program's files.

    `device` is the device as a model at its trip value, whose initial state is on the orbit that touches; `results` are
    the branches that lead there; `report` is the report as JSON. Designs can be copied and pickled, with all but what
    draws them.
    """

    name: str
    control: str
    trip_value: float
    reset_value: Optional[float]
    outcome: str
    outcome_reason: str
    wishes: str
    warnings: List[str]
    dimensions: Dict[str, float]
    tables: Dict[str, Table]
    facts: Table
    sensitivities: Optional[Table]
    earlier: Optional[Table]
    trip_times: Optional[Table]
    tuning: Optional[Table]
    devices: Optional[Table]
    curves: Dict[str, Table]
    planes: Dict[Tuple[str, str], Table]
    problems: Dict[str, int]

    def __init__(self, core: Any, inputs: List[Tuple[str, str]], source: DesignText) -> None:
        self._core, self._inputs, self._source, self._folder = core, inputs, source, source.folder
        self.name, self.control = core.name, core.control
        self.trip_value, self.reset_value = core.trip_value, core.reset_value
        self.outcome, self.outcome_reason = core.outcome, core.outcome_reason
        self.wishes, self.warnings = core.wishes, list(core.warnings)
        self.problems = dict(core.problems)
        self.dimensions = {one["name"]: one["value"] for one in core.dimensions}
        self.tables = {name: Table(*core.table(i)) for i, name in enumerate(core.table_names)}
        self.facts = self.tables["facts"]
        super().__init__(self.facts["quantity"], self.facts["value"])
        self.sensitivities, self.earlier = self.tables.get("sensitivities"), self.tables.get("earlier")
        self.trip_times = self.tables.get("trip-times")
        self.tuning, self.devices = self.tables.get("tuning"), self.tables.get("devices")
        names = list(self.dimensions)
        self.curves = {name: self.tables[f"curve-{name}"] for name in names if f"curve-{name}" in self.tables}
        self.planes = {(one, other): self.tables[f"plane-{one}-{other}"] for one in names for other in names
                       if f"plane-{one}-{other}" in self.tables}

    @property
    def regular(self) -> bool:
        """Whether there is nothing to look at: the program's exit code is 0 then, and 3 otherwise."""
        return not self.warnings

    @property
    def wants(self) -> Table:
        """What was wanted: limits, value, whether it is met and whether it binds, the weight of a looser limit."""
        import numpy

        rows = self._core.wants
        numbers = [numpy.array([numpy.nan if row[key] is None else row[key] for row in rows], dtype=float)
                   for key in ("least", "most", "value", "violation", "weight")]
        truths = [numpy.array([row[key] for row in rows], dtype=bool) for key in ("met", "binds")]
        return Table(["name", "least", "most", "value", "violation", "weight", "met", "binds"],
                     [[row["name"] for row in rows], *numbers, *truths])

    @property
    def device(self) -> Model:
        """The device as a model at its trip value, whose initial state is on the orbit that touches."""
        return Model(text=self._core.device_text)

    @property
    def results(self) -> Study:
        """The branch on which the device comes to its trip point, as a `graze.Study`."""
        designed = os.path.join(self._folder.path, "designed.sqlite")
        path = designed if os.path.exists(designed) else os.path.join(self._folder.path, "results.sqlite")
        return Study(path, _store=StoredFile(path, self._folder))

    @property
    def report(self) -> str:
        """The report as JSON, as the program writes it."""
        return str(self._core.json)

    def verilog_a(self) -> str:
        """The device as a module of Verilog-A for circuit simulators. InputError for models that it cannot express."""
        return str(self._core.verilog_a())

    def layout(self, *, set: Any = None, wafer: bool = False) -> Any:
        """Draws the masks of the device, whose drawing is solved for: `graze.layout` with from_design. Needs a design
        whose table [device] has the shape. Returns a `graze.Layout`."""
        from ._layout import drawn

        return drawn(self._source, set, wafer, self)

    def plot(self, *, axes: Any = None) -> Any:
        """Draws the page for a review: the trip value over each dimension and in planes of two, trip times, the tuning
        curve, the devices. Returns the axes."""
        from ._plot import draw

        return draw(self._core.figure(), axes)

    def save(self, folder: Any, *, pictures: bool = True) -> List[str]:
        """Writes what `graze design --output FOLDER` writes: tables, report.json, device.toml, device.va, the result
        files, and the page (page.svg and page.pdf, drawn by matplotlib). Returns the paths. FileError for a folder that
        is not empty."""
        folder = empty_folder(folder)
        written: List[str] = []

        def path(name: str) -> str:
            written.append(os.path.join(folder, name))
            return written[-1]

        for i, name in enumerate(self._core.table_names):
            write_file(path(name + ".csv"), self._core.csv(i), self._inputs)
        write_file(path("report.json"), self.report, self._inputs)
        write_file(path("device.toml"), self._core.device_text, self._inputs)
        if self._core.has_verilog_a:
            write_file(path("device.va"), self.verilog_a(), self._inputs)
        for name in ("results.sqlite", "designed.sqlite"):
            source = os.path.join(self._folder.path, name)
            if os.path.exists(source):
                _graze.ResultFile(source, write=True).copy_to(path(name))
        if pictures:
            self._draw_page(path)
        return written

    def _draw_page(self, path: Callable[[str], str]) -> None:
        from ._plot import page_alone

        page = page_alone(self._core.figure())
        for name in ("page.svg", "page.pdf"):
            with Replacement(path(name), self._inputs) as temporary:
                page.savefig(temporary)

    def __getstate__(self) -> Dict[str, Any]:
        return {**vars(self), "_core": _Kept(self._core)}

    def __repr__(self) -> str:
        values = ", ".join(f"{name} {value:.6g}" for name, value in self.dimensions.items())
        wishes = f"; wishes {self.wishes}" if self.wishes else ""
        return (f"<Design {self.name}: {self.outcome} at {self.control} = {self.trip_value:.9g}; {values}{wishes}"
                f"{'' if self.regular else f'; warnings: {len(self.warnings)}'}>")

    def _repr_html_(self) -> str:
        return f"<b>{self.name}</b>{self.facts._repr_html_()}"


@interruptible()
def design(design: Any = None, *, text: Optional[str] = None, threads: Optional[int] = None, executor: Any = None,
           progress: Progress = None, **keys: Any) -> Design:
    """Designs a switch: finds dimensions that meet a list of wishes, and writes up what the device does.

    design: the name of a shipped design (`graze.designs()`), or a design file; or text: the text of such a file.
    keys: the keys of design files (docs/design.md): name, model (a `graze.Model`, a shipped name or a file), control,
        approach, dimensions, wanted, yield_ (for `yield`), trip, points, planes, adjustable, set, ... Beside a design or
        a text they change its keys; a dict changes what it names, None takes a key away.

            graze.design("mems-switch", wanted={"value": 0.25}, yield_={"devices": 500})

    threads: how many (as many as the machine has); results do not depend on it.
    executor: a concurrent.futures.Executor whose workers solve for the devices that are made with the tolerances, in place
        of threads; the results are the same.
    progress: True for a line that tells what is done, or a function of that text.

    Returns a Design. Raises InputError for a design that has a mistake (`all` lists all of them), and where no trip point
    is found; Interrupted after Ctrl-C; WorkersLost of an executor. Wishes that cannot be met are no error: see
    `Design.wishes` and `warnings`.
    """
    from ._executors import handed_out

    source = DesignText(design, text, keys, "design()")
    read = source.read(_graze.Design.parsed)
    inputs = [("the design, or what it reads,", path) for path in (source.path, *read.inputs)]
    try:
        with attended(progress, "text") as told, handed_out(executor, told) as (parts, look):
            core = read.compute(source.folder.path, threads=checked.number_of_threads(threads), told=look, parts=parts)
    except InputError as error:
        raise source.told(error) from None
    return Design(core, inputs, source)


class _Kept:
    """What a copy of a design has in place of its compiled part."""

    def __init__(self, core: Any) -> None:
        self.wants, self.json, self.device_text = core.wants, core.json, core.device_text
        self.has_verilog_a = core.has_verilog_a
        self._verilog_a: str = core.verilog_a() if core.has_verilog_a else ""
        self.table_names = core.table_names
        self._tables: List[str] = [core.csv(i) for i in range(len(core.table_names))]

    def csv(self, table: int) -> str:
        return self._tables[table]

    def verilog_a(self) -> str:
        if not self.has_verilog_a:
            raise InputError("Verilog-A cannot express this model", "the design itself tells why")
        return self._verilog_a

    def figure(self) -> Any:
        raise OrderError("what draws a design is not kept in copies of it", "draw the design that was computed")


def designs() -> Dict[str, str]:
    """The designs that come with graze: name -> what it does."""
    return {name: _graze.Design.parsed(_graze.shipped_design_text(name), name).text
            for name in _graze.shipped_designs()}


def design_text(name: str) -> str:
    """The file of a shipped design, as a copy to change. InputError for an unknown name, with the nearest."""
    return str(_graze.shipped_design_text(checked.text(name, "name")))
