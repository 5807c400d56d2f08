"""Switches designed from a list of wishes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Callable, Dict, Iterator, List, Optional, Tuple

from . import _graze
from ._errors import Error, FileError, InputError, Interrupted
from ._keywords import toml_key, toml_value
from ._model import Model
from ._output import OwnFolder, Replacement, empty_folder, write_file
from ._progress import Progress, Stopped
from ._table import Table


def told_text(progress: Progress) -> Tuple[Optional[Callable[[str], None]], Callable[[], None]]:
    """A function for the compiled part that is called with a text (None: nothing is told), and one that ends the telling.

    progress: True shows a line of tqdm, where tqdm is installed; a function is called with the text, and stops the
        computation where it returns False.
    """
    if progress is None or progress is False:
        return None, _nothing
    if progress is not True:
        if not callable(progress):
            raise TypeError(f"progress must be True or a function, not {type(progress).__name__}")
        asked = progress

        def tell(text: str) -> None:
            if asked(text) is False:
                raise Stopped

        return tell, _nothing
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None, _nothing
    bar = tqdm(bar_format="{desc} {elapsed}")

    def show(text: str) -> None:
        bar.set_description_str(text)

    return show, bar.close


def _nothing() -> None:
    pass


def number_of_threads(threads: Optional[int]) -> int:
    """How many threads compute. None: as many as the process may use."""
    from ._runs import _threads

    return int(_threads(threads))


class DesignText:
    """The text of a design file, from a shipped design or a file, and what is changed of it."""

    def __init__(self, design: Any, text: Any, keys: Dict[str, Any], called: str) -> None:
        """keys: of design files; dicts in them change what they name, None takes a key away."""
        self.called = called
        self.folder = OwnFolder()
        self._keys: Optional[List[str]] = None  # of each line; None: the text is that of a file
        if design is not None and text is not None:
            raise InputError(f"{called} was given a design and a text", "give one of them")
        self.path = ""  # of the user's file
        if text is not None:
            self.file, self.text = "design.toml", _as_text(text, called)
        elif design is not None:
            self.file, self.text = self._read(design)
        else:
            self.file, self.text = "design.toml", ""
        if keys or (design is None and text is None):
            self._change({name[:-1] if name in ("yield_", "set_") else name: value for name, value in keys.items()})

    def _read(self, design: Any) -> Tuple[str, str]:
        try:
            name = os.fspath(design)
        except TypeError:
            raise InputError(f"{self.called} was given a {type(design).__name__} as the design",
                             "give the name of a shipped design, or a file") from None
        if "/" not in name and not name.endswith(".toml"):
            return name, str(_graze.shipped_design_text(name))
        try:
            with open(name, encoding="utf-8") as file:
                self.path = name
                return name, file.read()
        except OSError as error:
            raise FileError(f"the design '{name}' cannot be read: {error.strerror}",
                            "name a file, or one of graze.designs()") from None
        except UnicodeDecodeError:
            raise FileError(f"the design '{name}' is no text in UTF-8", "name another file") from None

    def _change(self, keys: Dict[str, Any]) -> None:
        import tomllib

        try:
            given = tomllib.loads(self.text)
        except tomllib.TOMLDecodeError:
            return  # the library's reader says what is wrong, and where
        lines: List[str] = []
        self._keys = []
        for name, value in _merged(given, keys).items():
            if isinstance(value, Model):
                value = self._model_file(value)
            try:
                lines.append(f"{toml_key(name)} = {toml_value(value, name)}")
            except InputError as error:
                raise InputError(error.problem, error.remedy, f"{self.called}, {name}") from None
            self._keys.append(name)
        self.text = "\n".join(lines) + "\n"

    def _model_file(self, model: Model) -> str:
        path = os.path.join(self.folder.path, f"{model.name or 'model'}.toml")
        model.save(path)
        return path

    def told(self, error: Error) -> Error:
        """An error with the place in the call instead of that in the text."""
        if self._keys is None:
            return error
        for one in error.all:
            if one.file == self.file:
                known = 0 < one.line <= len(self._keys)
                one.file = f"{self.called}, {self._keys[one.line - 1]}" if known else self.called
                one.line = one.column = 0
        return error

    def read(self, reader: Callable[[str, str], Any]) -> Any:
        """What a reader of the library makes of the text."""
        try:
            return reader(self.text, self.file)
        except InputError as error:
            raise self.told(error) from None


def _as_text(text: Any, called: str) -> str:
    if not isinstance(text, str):
        raise InputError(f"{called} was given a {type(text).__name__} as text", "give a text")
    return text


def _merged(given: Any, changes: Any) -> Dict[str, Any]:
    result = dict(given)
    for name, value in changes.items():
        if value is None:
            result.pop(name, None)
        elif isinstance(value, Mapping) and isinstance(result.get(name), dict):
            result[name] = _merged(result[name], value)
        else:
            result[name] = value
    return result


class Design(Mapping):  # type: ignore[type-arg]
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
    the branches that lead there; `report` is the report as JSON.
    """

    def __init__(self, core: Any, inputs: List[Tuple[str, str]], source: DesignText) -> None:
        self._core, self._inputs, self._source, self._folder = core, inputs, source, source.folder
        self.name, self.control = core.name, core.control
        self.trip_value, self.reset_value = core.trip_value, core.reset_value
        self.outcome, self.outcome_reason = core.outcome, core.outcome_reason
        self.wishes, self.warnings = core.wishes, list(core.warnings)
        self.problems: Dict[str, int] = dict(core.problems)
        self.dimensions = {one["name"]: one["value"] for one in core.dimensions}
        self.tables = {name: Table(*core.table(i)) for i, name in enumerate(core.table_names)}
        self.facts = self.tables["facts"]
        self.sensitivities, self.earlier = self.tables.get("sensitivities"), self.tables.get("earlier")
        self.trip_times = self.tables.get("trip-times")
        self.tuning, self.devices = self.tables.get("tuning"), self.tables.get("devices")
        names = list(self.dimensions)
        self.curves = {name: self.tables[f"curve-{name}"] for name in names if f"curve-{name}" in self.tables}
        self.planes = {(one, other): self.tables[f"plane-{one}-{other}"] for one in names for other in names
                       if f"plane-{one}-{other}" in self.tables}

    def __getitem__(self, quantity: str) -> Any:
        try:
            return self.facts["value"][self.facts["quantity"].index(quantity)]
        except ValueError:
            raise KeyError(f"there is no fact {quantity!r}; there are {', '.join(self)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self.facts["quantity"])

    def __len__(self) -> int:
        return len(self.facts)

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
        return Model._of(self._core.device)

    @property
    def results(self) -> Any:
        """The branch on which the device comes to its trip point, as a `graze.Study`."""
        from ._runs import Study

        designed = os.path.join(self._folder.path, "designed.sqlite")
        study: Any = Study(designed if os.path.exists(designed) else os.path.join(self._folder.path, "results.sqlite"))
        study._folder = self._folder
        return study

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

    def __repr__(self) -> str:
        values = ", ".join(f"{name} {value:.6g}" for name, value in self.dimensions.items())
        wishes = f"; wishes {self.wishes}" if self.wishes else ""
        return (f"<Design {self.name}: {self.outcome} at {self.control} = {self.trip_value:.9g}; {values}{wishes}"
                f"{'' if self.regular else f'; warnings: {len(self.warnings)}'}>")

    def _repr_html_(self) -> str:
        return f"<b>{self.name}</b>{self.facts._repr_html_()}"


def design(design: Any = None, *, text: Optional[str] = None, threads: Optional[int] = None, progress: Progress = None,
           **keys: Any) -> Design:
    """Designs a switch: finds dimensions that meet a list of wishes, and writes up what the device does.

    design: the name of a shipped design (`graze.designs()`), or a design file; or text: the text of such a file.
    keys: the keys of design files (docs/design.md): name, model (a `graze.Model`, a shipped name or a file), control,
        approach, dimensions, wanted, yield_ (for `yield`), trip, points, planes, adjustable, set, ... Beside a design or
        a text they change its keys; a dict changes what it names, None takes a key away.

            graze.design("mems-switch", wanted={"value": 0.25}, yield_={"devices": 500})

    threads: how many (as many as the machine has); results do not depend on it.
    progress: True for a line that tells what is done, or a function of that text.

    Returns a Design. Raises InputError for a design that has a mistake (`all` lists all of them), and where no trip point
    is found; Interrupted after Ctrl-C. Wishes that cannot be met are no error: see `Design.wishes` and `warnings`.
    """
    source = DesignText(design, text, keys, "design()")
    read = source.read(_graze.Design.parsed)
    inputs = [("the design, or what it reads,", path) for path in (source.path, *read.inputs)]
    told, close = told_text(progress)
    try:
        core = read.compute(source.folder.path, threads=number_of_threads(threads), told=told)
    except KeyboardInterrupt:
        raise Interrupted() from None
    except InputError as error:
        raise source.told(error) from None
    finally:
        close()
    return Design(core, inputs, source)


def designs() -> Dict[str, str]:
    """The designs that come with graze: name -> what it does."""
    return {name: _graze.Design.parsed(_graze.shipped_design_text(name), name).text
            for name in _graze.shipped_designs()}


def design_text(name: str) -> str:
    """The file of a shipped design, as a copy to change. InputError for an unknown name, with the nearest."""
    return str(_graze.shipped_design_text(name))
