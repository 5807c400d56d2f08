"""Wafers of devices that were made by simulation."""

from __future__ import annotations

import html
import math
import os
from typing import TYPE_CHECKING, Any, Dict, List

from ._attributes import Fixed
from ._errors import InputError
from ._facts import Facts
from ._output import OwnFolder, Replacement, empty_folder, write_file
from ._table import Table

if TYPE_CHECKING:
    from ._layout import Layout


class Wafers(Fixed, Facts):
    """Wafers of devices that were made by simulation.

    A mapping from the quantities of `facts` to their values: `wafers["yield"]`. `devices` is a table of all devices: where
    each lies, how it departs from the drawing, where it trips. `problems` is a dict of what prevents devices from tripping,
    and how many it concerns; `failed` says how many have no trip value that was found; `count` and `seed` are as asked.
    """

    count: int
    seed: int
    facts: Table
    devices: Table
    failed: int
    problems: Dict[str, int]

    def __init__(self, layout: Layout, core: Any, count: int, seed: int, folder: OwnFolder) -> None:
        self._layout, self._core, self._folder = layout, core, folder
        self.count, self.seed = count, seed
        self.facts, self.devices = Table(*core.facts()), Table(*core.devices())
        super().__init__(self.facts["quantity"], self.facts["value"])
        self._control, self._unit, self._limits = core.control, core.unit, (core.least, core.greatest)
        self._csv = core.facts_csv(), core.devices_csv()
        self._report = ""  # once it is asked for
        self.failed = core.failed
        self.problems = dict(core.problems)

    @property
    def report(self) -> str:
        """The report as JSON, as the program writes it."""
        if not self._report:
            self._report = str(self._layout._core.wafer_json(self._core, self.count, self.seed))
        return self._report

    def __getstate__(self) -> Dict[str, Any]:
        return {**vars(self), "_report": self.report, "_core": None}

    def save(self, folder: Any) -> List[str]:
        """Writes wafers.csv, devices.csv, report.json, and the maps map.svg and map.png, drawn by matplotlib, into a folder.
        Returns the paths. FileError for a folder that is not empty."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        folder = empty_folder(folder)
        paths = [os.path.join(folder, name)
                 for name in ("wafers.csv", "devices.csv", "report.json", "map.svg", "map.png")]
        for path, text in zip(paths, (*self._csv, self.report)):
            write_file(path, text)
        columns = self._columns()
        page = Figure(figsize=(3.2 * columns, 3.2 * math.ceil(self._drawn() / columns) + 0.4), layout="constrained")
        FigureCanvasAgg(page)
        self.plot(axes=page.subplots(math.ceil(self._drawn() / columns), columns, squeeze=False).ravel())
        for path in paths[3:]:
            with Replacement(path) as temporary:
                page.savefig(temporary)
        return paths

    def _drawn(self) -> int:
        return min(self.count, 16)

    def _columns(self) -> int:
        return math.ceil(math.sqrt(self._drawn()))

    def plot(self, *, axes: Any = None) -> Any:
        """Draws the devices on their wafers (the first 16), coloured by the value at which they trip; crosses have none;
        those as wanted are ringed. axes: one for each wafer. Returns them."""
        import numpy

        from ._plot import plane_axes

        drawn, columns = self._drawn(), self._columns()
        if axes is None:
            from matplotlib import pyplot

            rows = math.ceil(drawn / columns)
            _, axes = pyplot.subplots(rows, columns, figsize=(3.2 * columns, 3.2 * rows + 0.4), squeeze=False,
                                      layout="constrained")
        axes = numpy.array(plane_axes(axes))
        if len(axes) < drawn:
            raise InputError(f"{len(axes)} axes were given, and there are {drawn} wafers", "give as many, or none")
        values = numpy.array([_number(value) for value in self.devices[self._control]])
        scale = {"vmin": numpy.nanmin(values), "vmax": numpy.nanmax(values)} if numpy.isfinite(values).any() else {}
        least, greatest = self._limits
        least, greatest = -math.inf if least is None else least, math.inf if greatest is None else greatest
        ringed = (values >= least) & (values <= greatest) if (least, greatest) != (-math.inf, math.inf) else None
        shown = None
        for number, one in enumerate(axes[:drawn], 1):
            of_wafer = numpy.asarray(self.devices["wafer"]) == number
            shown = self._draw_wafer(one, number, of_wafer, values, scale, ringed) or shown
        for one in axes[drawn:]:
            one.set_axis_off()
        if shown is not None:
            unit = f" ({self._unit})" if self._unit else ""
            words = "" if ringed is None else "; ringed: as wanted"
            axes[0].figure.colorbar(shown, ax=list(axes), label=f"{self._control}{unit}{words}", shrink=0.8)
        return axes

    def _draw_wafer(self, axes: Any, number: int, of_wafer: Any, values: Any, scale: Dict[str, Any],
                    ringed: Any) -> Any:
        import numpy
        from matplotlib.patches import Circle

        x, y = (numpy.asarray(self.devices[name], dtype=float)[of_wafer] for name in ("x", "y"))
        found = numpy.isfinite(values[of_wafer])
        radius = self._layout._core.wafer_radius
        axes.add_patch(Circle((0, 0), _in_unit(radius, self.devices.units.get("x", "um")), fill=False, color="0.6"))
        shown = axes.scatter(x[found], y[found], c=values[of_wafer][found], s=30, **scale) if found.any() else None
        axes.plot(x[~found], y[~found], "x", color="black")
        if ringed is not None:
            inside = ringed[of_wafer]
            axes.plot(x[inside], y[inside], "o", markerfacecolor="none", color="black", markersize=9)
        axes.set_aspect("equal")
        axes.set_xticks([])
        axes.set_yticks([])
        axes.set_title(f"wafer {number}", fontsize="small")
        return shown

    def __repr__(self) -> str:
        facts = ", ".join(f"{name} {value:.6g}" if isinstance(value, float) else f"{name} {value}"
                          for name, value in list(self.items())[:4])
        return f"<Wafers of {self._layout.name}: {self.count} with {len(self.devices)} devices; {facts}>"

    def _repr_html_(self) -> str:
        return f"<p>{html.escape(repr(self))}</p>{self.facts._repr_html_()}"


def _in_unit(micrometres: float, unit: str) -> float:
    return micrometres * {"um": 1.0, "mm": 1e-3, "m": 1e-6}.get(unit, 1.0)


def _number(value: Any) -> float:
    return float(value) if isinstance(value, (int, float)) else math.nan
