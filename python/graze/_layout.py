"""From a design to masks: drawings of switches, their rules, and the model of what is etched."""

from __future__ import annotations

import os
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Tuple, Union

from . import _arguments as checked, _graze
from ._attributes import Fixed
from ._design import Design
from ._design_text import DesignText
from ._errors import Error, InputError, Interrupted, relocated
from ._facts import Facts
from ._model import Model
from ._output import OwnFolder, Replacement, write_file
from ._progress import Progress, attended, interruptible
from ._table import Table
from ._wafers import Wafers

_PICTURES = (".svg", ".png", ".pdf")
_COLOURS = {(1, 0): "#9ecae1", (2, 0): "#fdae6b", (10, 0): "#3182bd", (10, 1): "#31a354", (10, 2): "#74c476",
            (11, 0): "#e6550d", (11, 1): "#fdd0a2", (12, 0): "#756bb1", (20, 0): "black", (21, 0): "black"}
_MATERIALS = {"silicon": "0.6", "resist": "#de2d26", "epoxy": "#fec44f", "aluminium": "#3182bd"}


class LumpedModel(NamedTuple):
    """The model of a drawn and etched device, in SI units: a mass in kg on a spring in N/m with a damping in N s/m, plates
    of an area in m^2 and a gap in m, and the way in m to the stops; the natural `frequency` in Hz, the `damping_ratio`,
    `pull_in`, the voltage in V at which it snaps through at rest; the number of the `squeeze` film, the way `closure` in m
    until the electrodes touch, and the largest stress of a beam by travel, in Pa/m."""

    mass: float
    stiffness: float
    damping: float
    area: float
    gap: float
    stop: float
    frequency: float
    damping_ratio: float
    pull_in: float
    squeeze: float
    closure: float
    stress_per_travel: float


class ComparedDevice(NamedTuple):
    """A drawn device beside the designed one: a `table` of quantities (designed, drawn, percent of difference), whether
    the drawn one is as designed and has what is wanted (`met`), and two texts for `--set @FILE` of the program: the
    numbers of the `drawing`, and the `parameters` of the model."""

    table: Table
    met: bool
    drawing: str
    parameters: str


class Layout(Fixed, Facts):
    """A drawn device, or a wafer of them.

    `table` has what is measured on the drawing, and the model of the etched device; `layout["gap"]` is one of its values
    for the (first) device. `rules` is a table of the fabrication rules, `holds` whether all hold, and `broken` lists those
    that do not, in words. `lumped` is the etched device's model in SI units, `parameters` a dict of the parameters that it
    gives to the model of the design, and `device` that model with them.

    `save(path)` writes masks, pictures and texts; `wafers(count)` makes wafers of devices by simulation. Layouts can be
    copied and pickled: a copy is drawn anew.
    """

    is_wafer: bool
    table: Table
    rules: Table
    name: str
    top: str
    broken: List[str]

    def __init__(self, core: Any, source: DesignText, inputs: List[Tuple[str, str]], options: List[str],
                 asked: Tuple[Dict[str, Any], bool, Any]) -> None:
        """asked: `set`, `wafer` and the folder of the designed device (None: none)."""
        self._core, self._source, self._inputs, self._options, self._asked = core, source, inputs, options, asked
        self.name = core.name
        self.top = core.top
        self.is_wafer = asked[1]
        self.table = Table(*core.table())
        super().__init__(self.table["what"], map(float, self.table["value"]))
        rows = core.findings
        names = ("rule", "value", "limit", "unit", "holds", "part", "device", "x", "y", "text")
        self.rules = Table(names, [self._column(rows, name) for name in names])
        self.broken = [row["text"] for row in rows if not row["holds"]]

    @staticmethod
    def _column(rows: List[Dict[str, Any]], name: str) -> Any:
        import numpy

        values = [row[name] for row in rows]
        return values if name in ("rule", "unit", "part", "device", "text") else numpy.array(values)

    @property
    def holds(self) -> bool:
        """Whether all fabrication rules hold."""
        return not self.broken

    @property
    def lumped(self) -> LumpedModel:
        """The model of the etched device in SI units. InputError for a wafer with devices that differ."""
        return LumpedModel(**self._core.lumped())

    @property
    def parameters(self) -> Dict[str, float]:
        """What the etched device makes of the parameters of the design's model, in their units."""
        return dict(self._core.parameters())

    @property
    def device(self) -> Model:
        """The model of the design with the parameters of the etched device."""
        return Model._of(self._core.model())

    def polygons(self, mask: Optional[int] = None) -> Dict[Tuple[int, int], List[Any]]:
        """Polygons as arrays of corners (x, y) in micrometres, by layer and datatype of GDSII (`graze.mask_layers` says
        what they are). mask: 1 (seen mirrored) or 2: only this one, as it is written."""
        result: Dict[Tuple[int, int], List[Any]] = {}
        for layer, datatype, corners in self._core.polygons(_mask(mask)):
            result.setdefault((layer, datatype), []).append(corners)
        return result

    def gds(self, mask: Optional[int] = None, *, despite_rules: bool = False) -> bytes:
        """The drawing as GDSII, with a top cell for each mask; or one mask (1 or 2) alone. InputError where a rule is
        broken, unless despite_rules."""
        self._require_ruled(despite_rules)
        return bytes(self._core.gds(_mask(mask)))

    def verilog_a(self) -> str:
        """The etched device as a module of Verilog-A for circuit simulators."""
        return str(self._core.verilog_a())

    def recipe(self, *, despite_rules: bool = False) -> str:
        """The process recipe, step by step, in Markdown."""
        despite = checked.truth(despite_rules, "despite_rules") and self.broken
        return str(self._core.recipe([*self._options, *(["--despite-rules"] if despite else [])]))

    def markers(self) -> str:
        """The places that break a rule, as markers of KLayout (.lyrdb)."""
        return str(self._core.markers())

    def _require_ruled(self, despite_rules: bool) -> None:
        if not checked.truth(despite_rules, "despite_rules"):
            try:
                self._core.require_ruled()
            except InputError as error:
                raise self._source.told(error) from None

    def save(self, path: Any, *, mask: Optional[int] = None, despite_rules: bool = False) -> None:
        """Writes a file, whose ending says which: masks (.gds); a picture (.svg, .png, .pdf), drawn by matplotlib; the
        places that break a rule (.lyrdb); the etched device as Verilog-A (.va), or its parameters (.toml) for `--set @FILE`
        of the program; the process recipe (.md).

        mask: 1 or 2: this mask alone. An existing file is replaced, but for the design. InputError where a rule is broken
        (except for .lyrdb), unless despite_rules.
        """
        file = Replacement(path, self._inputs)
        ending = os.path.splitext(file.path)[1].lower()
        written: Dict[str, Callable[[], Union[str, bytes]]] = {
            ".gds": lambda: bytes(self._core.gds(_mask(mask))), ".lyrdb": self.markers, ".va": self.verilog_a,
            ".toml": lambda: str(self._core.parameter_text()), ".md": lambda: self.recipe(despite_rules=despite_rules)}
        written[".gds2"] = written[".gdsii"] = written[".gds"]
        if ending not in written and ending not in _PICTURES:
            raise InputError(f"the ending of '{file.path}' does not say what kind of file to write",
                             f"let the name end in {', '.join(sorted({*written, *_PICTURES}))}")
        if ending != ".lyrdb":
            self._require_ruled(despite_rules)
        if ending in _PICTURES:
            with file as temporary:
                self._page(mask).savefig(temporary)
        else:
            write_file(file.path, written[ending](), self._inputs)

    def _page(self, mask: Optional[int]) -> Any:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        page = Figure(figsize=(8, 8), layout="constrained")
        FigureCanvasAgg(page)
        self.plot(mask, axes=page.add_subplot())
        return page

    def plot(self, mask: Optional[int] = None, *, axes: Any = None) -> Any:
        """Draws the polygons to scale, coloured by layer; mask: 1 or 2: only this one, as it is written. Returns the
        axes."""
        from matplotlib.collections import PolyCollection

        axes = _axes(axes)
        texts = mask_layers()
        for layer, shapes in sorted(self.polygons(mask).items()):
            outlined = layer[0] >= 20
            axes.add_collection(PolyCollection(
                shapes, facecolors="none" if outlined else _COLOURS.get(layer, "0.7"), linewidths=0.5,
                edgecolors="black" if outlined else "none", label=texts[layer]))
        axes.autoscale_view()
        axes.set_aspect("equal")
        axes.set_xlabel("x (um)")
        axes.set_ylabel("y (um)")
        axes.set_title(self.name if mask is None else f"{self.name}, mask {mask}", fontsize="medium")
        axes.legend(fontsize="x-small", loc="center left", bbox_to_anchor=(1, 0.5))
        return axes

    def steps(self) -> List[Tuple[str, Table]]:
        """Cross-sections after each step of the process: what is done, and a table of slabs (material, left, right, low,
        high, in micrometres)."""
        import numpy

        names = ("left", "right", "low", "high")
        return [(text, Table(["material", *names],
                             [[slab[0] for slab in slabs],
                              *(numpy.array([slab[i + 1] for slab in slabs], dtype=float) for i in range(4))],
                             ["", *["um"] * 4])) for text, slabs in self._core.steps()]

    def plot_steps(self, *, axes: Any = None) -> Any:
        """Draws the cross-sections after each step of the process. Returns the axes, one for each."""
        import numpy
        from matplotlib.patches import Rectangle

        from ._plot import plane_axes

        steps = self.steps()
        if axes is None:
            from matplotlib import pyplot

            _, axes = pyplot.subplots(len(steps), 1, figsize=(7, 1.1 * len(steps)), layout="constrained", sharex=True)
        axes = numpy.array(plane_axes(axes))
        if len(axes) != len(steps):
            raise InputError(f"{len(axes)} axes were given, and there are {len(steps)} steps", "give as many, or none")
        for one, (text, slabs) in zip(axes, steps):
            for material, left, right, low, high in zip(*slabs.values()):
                one.add_patch(Rectangle((left, low), right - left, high - low, facecolor=_MATERIALS[material]))
            one.autoscale_view()
            one.set_title(text, fontsize="x-small", loc="left")
        axes[-1].set_xlabel("x (um)")
        return axes

    @interruptible()
    def compare(self, *, threads: Optional[int] = None, executor: Any = None,
                progress: Progress = None) -> ComparedDevice:
        """Where and how fast the drawn device trips, and which wishes it meets, beside the designed one. Needs a drawing
        of a designed device (`from_design`). executor: see `graze.design`."""
        folder = OwnFolder()
        made = self._attended(self._core.drawn, folder.path, threads=threads, executor=executor, progress=progress)
        return ComparedDevice(Table(*made["table"]), made["met"], made["drawing"], made["parameters"])

    @interruptible()
    def wafers(self, count: int, *, seed: int = 1, despite_rules: bool = False, threads: Optional[int] = None,
               executor: Any = None, progress: Progress = None) -> Wafers:
        """Makes wafers of devices by simulation, with the variations of the section `spread` of the design: where each
        device trips, and how many are as wanted.

        count: of wafers. seed: of the random numbers. Results do not depend on threads.
        executor: a concurrent.futures.Executor whose workers solve for the devices, in place of threads; the results are
            the same.

        InputError where a rule is broken, unless despite_rules, and where the design does not say what varies; WorkersLost
        of an executor.
        """
        count, seed = checked.whole(count, "count", 1, 100_000), checked.whole(seed, "seed", 0, 2**53)
        despite = checked.truth(despite_rules, "despite_rules")
        folder = OwnFolder()
        made = self._attended(self._core.wafers, folder.path, count, seed=seed, despite_rules=despite,
                              threads=threads, executor=executor, progress=progress)
        return Wafers(self, made, count, seed, folder)

    def _attended(self, work: Callable[..., Any], *arguments: Any, threads: Optional[int], executor: Any,
                  progress: Progress, **words: Any) -> Any:
        from ._executors import handed_out

        try:
            with attended(progress, "text") as told, handed_out(executor, told) as (parts, look):
                return work(*arguments, **words, threads=checked.number_of_threads(threads), told=look, parts=parts)
        except InputError as error:
            raise self._source.told(error) from None

    def __reduce__(self) -> Tuple[Any, ...]:
        return drawn, (self._source, *self._asked)

    def __repr__(self) -> str:
        what = f"wafer, {len(self._core.devices)} kinds of devices" if self.is_wafer else "device"
        rules = "all rules hold" if self.holds else f"broken rules: {len(self.broken)}"
        return f"<Layout {self.name}: {what}; {rules}>"

    def _repr_html_(self) -> str:
        import base64
        import html
        import io

        text = f"<p>{html.escape(repr(self))}</p>"
        try:
            data = io.BytesIO()
            self._page(None).savefig(data, format="png", dpi=60)
        except ImportError:
            return text
        return f'<img src="data:image/png;base64,{base64.b64encode(data.getvalue()).decode()}">{text}'


def _mask(mask: Any) -> Optional[int]:
    return None if mask is None else checked.whole(mask, "mask", 1, 2)


def _axes(axes: Any) -> Any:
    if axes is None:
        from matplotlib import pyplot

        return pyplot.figure(figsize=(8, 8), layout="constrained").add_subplot()
    from ._plot import checked_axes

    return checked_axes(axes, 1)[0]


def _given(set_: Any) -> List[Tuple[str, Union[float, str]]]:
    def of(name: Any, value: Any) -> Tuple[str, Union[float, str]]:
        name = checked.text(name, "layout(), set")
        place = f"layout(), set, {name}"
        return name, checked.text(value, place) if isinstance(value, str) else checked.number(value, place)

    return [of(*one) for one in checked.a_dict(set_, "layout(), set", '{"gap": 14, "stop_gap": "7.5 um"}').items()]


@interruptible()
def layout(design: Any = None, *, text: Optional[str] = None, set: Any = None, wafer: bool = False,
           from_design: Any = None, **keys: Any) -> Layout:
    """Draws the masks of a switch, checks the rules of fabrication, and makes the model of the etched device.

    design: the name of a shipped design, or a design file whose table [device] has the dimensions (docs/layout.md); or
        text: the text of such a file. Without both, keys say everything.
    keys: the keys of such files, as device={"gap": 12}, process=..., rules=..., spread=..., wafer_ (for `wafer`): beside a
        design or a text they change its keys.
    set: numbers of [device], in micrometres, or of [process], in its unit, that replace those of the file: numbers, or texts
        with a unit ("7.5 um"). With from_design they remain as they are.
    wafer: draw the wafer with all its devices, instead of one device.
    from_design: the device that was found by `graze.design` of this design (what it returned, or the folder of its
        files): the drawing is solved for that has the wanted device after the etch.

    Returns a Layout. Raises InputError for a design that has a mistake, and for what cannot be drawn. Broken rules are no
    error here, but nothing but markers is written then, unless it is asked for.

        drawing = graze.layout("mems-switch-device", set={"stop_gap": "7.5 um"})
        drawing.save("device.gds")
    """
    if "wafer_" in keys:
        keys["wafer"] = keys.pop("wafer_")
    if isinstance(design, Design):
        raise InputError("layout() was given what design() has found as the design",
                         "name the design, and give from_design=FOUND")
    return drawn(DesignText(design, text, keys, "layout()"), set, wafer, from_design)


def drawn(source: DesignText, set_: Any, wafer: bool, from_design: Any) -> Layout:
    """The layout of a design's text; other arguments: see `layout`."""
    given = _given(set_) if set_ is not None else []
    wafer = checked.truth(wafer, "layout(), wafer")
    folder = _folder_of(from_design)
    try:
        core = _graze.Layout(source.text, source.file, given=given, wafer=wafer,
                             from_design=None if folder is None else os.fspath(folder))
    except KeyboardInterrupt:
        raise Interrupted() from None
    except InputError as error:
        raise source.told(relocated(error, _place_of)) from None
    inputs = [("the design", source.path)]
    if folder is not None:
        inputs.append(("the designed device", os.path.join(folder, "device.toml")))
    options = ["--from-design", folder] if isinstance(folder, str) else []
    for name, value in given:
        shown = value if isinstance(value, str) else repr(value).removesuffix(".0")
        options += ["--set", f"{name}={shown}"]
    return Layout(core, source, inputs, options, (dict(given), wafer, folder))


def _place_of(error: Error) -> Optional[str]:
    if error.file.startswith("given "):
        return f"layout(), set, {error.file[6:]}"
    return "layout(), from_design" if error.file == "from_design" else None


def _folder_of(from_design: Any) -> Union[None, str, OwnFolder]:
    """The folder with the device."""
    if isinstance(from_design, Design):
        folder = OwnFolder()
        write_file(os.path.join(folder.path, "device.toml"), from_design._core.device_text)
        return folder
    if from_design is None or isinstance(from_design, OwnFolder):
        return from_design
    return checked.path_of(from_design, "a folder", "layout(), from_design", "give what graze.design() returned, or a folder")


def mask_layers() -> Dict[Tuple[int, int], str]:
    """The layers of drawings: (layer, datatype) of GDSII -> what is on it."""
    return {(layer, datatype): text for layer, datatype, text in _graze.mask_layers()}
