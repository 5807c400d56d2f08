"""Runs and their results."""

from __future__ import annotations

import os
import re
from typing import TYPE_CHECKING, Any, Dict, Iterable, List, Optional, Tuple, Type, Union

from . import _arguments as checked, _graze
from ._attributes import Fixed
from ._computing import Ways
from ._errors import Error, InputError, relocated
from ._keywords import RunText, study_text, toml_key, toml_value
from ._model import Model
from ._output import Path
from ._progress import Progress, interruptible
from ._results import Results, Store
from ._table import Table
from ._written_study import write_study

if TYPE_CHECKING:
    from ._plot import Figure


Runs = Union["Run", Iterable["Run"]]
"""A run, or several."""


class Run(Fixed):
    """A run and its results.

    `name` and `kind`; `status`: "complete", "unfinished" or "failed"; `points` and `samples` are tables, `table(what)` is
    any table of `graze export`, `query(sql)` the rows of a query. `report` tells what was done, of a run that was carried
    out by this object (else None). Runs can be copied and pickled: results and all go with them.
    """

    kind = ""
    name: str
    report: Optional[Dict[str, Any]]
    _kinds: Dict[str, Type[Run]] = {}  # of all classes of runs

    def __init_subclass__(cls) -> None:
        if "kind" in vars(cls):
            Run._kinds[cls.kind] = cls

    def __init__(self, store: Results, name: str) -> None:
        self._store = store
        self.name = name
        self.report = None
        self._kept: Optional[Dict[str, Any]] = None  # record of a complete run, which does not change

    @property
    def _record(self) -> Dict[str, Any]:
        if self._kept is not None:
            return self._kept
        record: Optional[Dict[str, Any]] = self._store.read("run", self.name)
        if record is None:
            raise InputError(f"the file has no run '{self.name}'", "look which it has: list(read_results(FILE))")
        if record["status"] == "complete":
            self._kept = record
        return record

    @property
    def _model(self) -> Any:
        """The compiled part of the model, not to be changed."""
        return self._store.model_of(self._record["model"])

    @property
    def status(self) -> str:
        """"complete", "unfinished" or "failed"."""
        return str(self._record["status"])

    @property
    def failure(self) -> str:
        """Why the run failed, and what to do; empty if it did not."""
        return re.sub(r"(\w+\(\)):\d+:\d+: ", r"\1: ", self._record["failure"])

    @property
    def settings(self) -> str:
        """All settings of the run, as JSON."""
        return str(self._record["settings"])

    @property
    def model(self) -> Model:
        """A copy of the model, with the parameters and initial state of the run."""
        return Model._of(self._model.copied())

    @property
    def units(self) -> Dict[str, str]:
        """Units of what varies, of the states and of the values, by name; only those that are not empty."""
        record = self._record
        return {name: unit for part in ("states", "coordinates", "values") for name, unit in record[part] if unit}

    def table(self, what: str = "points", *, label: str = "", direction: str = "") -> Table:
        """A table of the run: points, samples, segments, multipliers, minima, ... as `graze export --what`.

        label, direction: only points with this label (of a branch also of this type), or of this direction. Raises
        InputError, which names the tables, for another word.
        """
        words = {"label": checked.text(label, "label"), "direction": checked.text(direction, "direction")}
        return Table(*self._store.read("table", checked.text(what, "what"), [self.name], **words))

    def query(self, sql: str) -> Table:
        """Rows of an SQL query in the result file, whose tables docs/result-file.md describes. InputError for what is no
        query, or changes something."""
        return Table(*self._store.read("query", checked.text(sql, "sql"), [self.name]))

    def findings(self, what: str = "points") -> Table:
        """A table of what an atlas, a run of kind "atlas", has found, as `graze atlas --what`: "curves", "points",
        "branches", "motions", or "left", which is what was not explored.

        Raises InputError, which names the tables, for another word, and for a run of another kind.
        """
        return Table(*self._store.read("findings", self.name, checked.text(what, "what")))

    @property
    def points(self) -> Table:
        """A row for each point, or orbit."""
        return self.table("points")

    @property
    def samples(self) -> Table:
        """A row for each sample."""
        return self.table("samples")

    def labels(self) -> Dict[str, int]:
        """How many points have each label; of branches, how many special points are of each type."""
        return dict(self._store.read("summary", self.name)["labels"])

    def plot(self, *, axes: Any = None, also: Runs = (), over: Runs = (), **keys: Any) -> Any:
        """Draws the run with matplotlib, and returns the axes: one, or an array with one for each panel.

        axes: where to draw: one axes, or a sequence of as many as there are panels; pyplot is not touched then. Without
            it a figure of pyplot is made, of the size and arrangement of the program's picture.
        also: other runs, such as branches and curves, drawn in the same panels, each in a colour of its own.
        over: runs whose points are drawn over those of this one, as measured ones over computed ones.
        Other arguments are the keys of pictures in studies (docs/study-format.md): kind ("bifurcation", "branch",
            "atlas", "basin", "map", "spectrum", "history", "portrait", "poincare", "regression", "scatter", "residuals";
            chosen by the kind of run), x, y (a name or a list: one panel each), samples, directions, at, points, x_range, y_range,
            logarithmic, title, names, x_label, y_label, size (in mm), font, grey, ...

        Raises InputError for keys and values that pictures do not have, and for a wrong number of axes.
        """
        from ._plot import draw

        return draw(self._picture(keys, over, also), axes)

    def figure(self, *, also: Runs = (), over: Runs = (), **keys: Any) -> "Figure":
        """The data that `plot` draws: panels with series of points, labels and texts. The arguments are those of
        `plot`."""
        from ._plot import Figure

        return Figure(self._picture(keys, over, also))

    def _picture(self, keys: Dict[str, Any], over: Runs = (), also: Runs = ()) -> Any:
        for key in ("run", "runs", "format"):
            if key in keys:
                remedy = "save the figure: axes.figure.savefig(...)" if key == "format" else "name other runs by also="
                raise InputError(f"plot() has no key '{key}'", remedy, f"plot(), {key}")
        others, above = _drawn_runs(also, "also"), _drawn_runs(over, "over")
        store, (name, *names) = self._together([self, *others, *above])
        for key in keys:
            checked.text(key, "plot()")
        shown = {"runs": [name, *names[:len(others)]], "over": names[len(others):] or None, **keys}
        if isinstance(keys.get("y"), str):
            shown["y"] = [keys["y"]]
        shown = {key: value for key, value in shown.items() if value is not None}
        lines = [f"{toml_key(key)} = {toml_value(value, key)}" for key, value in shown.items()]
        arguments = [("also" if others else "") if key == "runs" else key for key in shown]

        def place_of(one: Error) -> str:
            argument = arguments[one.line - 1] if 0 < one.line <= len(arguments) else ""
            return f"plot(), {argument}" if argument else "plot()"

        try:
            with store.reading() as file:
                return _graze.picture(file, "\n".join(lines) + "\n", "plot()")[0]
        except InputError as error:
            raise relocated(error, place_of)

    @staticmethod
    def _together(runs: List[Run]) -> Tuple[Results, List[str]]:
        """Results that have all of these runs, and their names there."""
        first = runs[0]._store
        if all(run._store is first or os.path.realpath(run._store.path) == os.path.realpath(first.path) for run in runs):
            return first, [run.name for run in runs]
        store = Store()
        return store, [store.take(run) for run in runs]

    def _small_picture(self) -> Any:
        """What is drawn in notebooks, where that is quick."""
        return self._picture({"size": 110}) if self._record["points"] <= 5000 else None

    @interruptible()
    def resume(self, *, threads: Optional[int] = None, executor: Any = None, progress: Progress = None) -> Run:
        """Goes on with a run that was interrupted, or whose executor lost its workers: what was computed is kept, and the
        results are those of a run without interruption, to the last bit. Returns the run."""
        return self._store.resume(self, Ways(threads, progress, executor))

    def study(self) -> str:
        """The text of a study that computes this run and those that it follows from. Its models and other files have to
        stand beside it: `write_study` writes all. InputError for runs that were read from a file."""
        return study_text("python", self._texts())

    def _texts(self) -> List[RunText]:
        store = self._store
        names = store.needed([self.name]) if isinstance(store, Store) else [self.name]
        for name in names:
            if name not in store.runs:
                raise InputError(f"run '{name}' was read from a file, which has no text of its study",
                                 "carry out the file itself: graze run FILE --output FOLDER does all of it again")
        return [store.runs[name] for name in names]

    def write_study(self, folder: Path) -> str:
        """Writes a study that computes this run and those that it follows from, with the files of models and records that
        it needs, into a folder, which is made if it is missing. `graze run FOLDER/study.toml` and
        `run_study(FOLDER/study.toml)` then give the same numbers. Existing files are replaced. Returns the path of the
        study."""
        return write_study(folder, self._texts(), self._store.models)

    def save(self, path: Path) -> None:
        """Writes a result file with this run and those that it follows from; `read_results` reads it, and `graze` too.
        FileError if the file is there already. An empty file NAME.lock remains beside it: it keeps other writers out."""
        self._store.copy(checked.path_of(path, "a result file"), [self.name])

    def __copy__(self) -> Run:
        other = type(self)(self._store, self.name)
        other.report = self.report
        return other

    def __reduce__(self) -> Tuple[Any, ...]:
        return _restored_run, (type(self), self._store, self.name, self.report)

    def __repr__(self) -> str:
        record = self._record
        return f"<{type(self).__name__} {self.name} of {record['model_name']}: {record['status']}>"

    def _repr_html_(self) -> str:
        from ._plot import small_picture

        return small_picture(self._small_picture, repr(self))


def _restored_run(of: Type[Run], store: Results, name: str, report: Optional[Dict[str, Any]]) -> Run:
    run = of(store, name)
    run.report = report
    return run


def _drawn_runs(runs: Any, key: str) -> List[Run]:
    if runs is None:
        return []
    listed = [runs] if isinstance(runs, Run) or not hasattr(runs, "__iter__") else list(runs)
    for run in listed:
        if not isinstance(run, Run):
            raise InputError(f"{key} has an object of type {type(run).__name__}", "give runs", f"plot(), {key}")
    return listed


class Ensemble(Run):
    """Motions of given length from many initial states or parameters."""

    kind = "simulate"

    def _picture(self, keys: Dict[str, Any], over: Runs = (), also: Runs = ()) -> Any:
        if (keys.get("title") is None and keys.get("at") is None and keys.get("x") is None
                and keys.get("kind") in (None, "history", "portrait")):
            points = self.points
            if len(points):  # the last motion is drawn
                values = (f"{name} = {points[name][-1]:.6g} {unit}".rstrip() for name, unit in self._record["coordinates"])
                keys = {**keys, "title": ", ".join(values) or None}
        return super()._picture(keys, over, also)


class Sweep(Run):
    """What motions settle on as a parameter changes step by step."""

    kind = "sweep"


class Basin(Run):
    """What motions settle on from many initial states."""

    kind = "basin"
