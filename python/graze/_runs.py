"""Runs: computations whose results are kept in a file, as those of studies are."""

from __future__ import annotations

import os
import shutil
import tempfile
import threading
import weakref
from collections.abc import Mapping

from . import _graze
from ._errors import Error, InputError, Interrupted, RunFailed, StudyError
from ._keywords import RunText, StudyText, keys_of, toml_key, toml_value
from ._model import Model
from ._progress import told_to
from ._table import Table


def _threads(threads) -> int:
    if threads is None:
        return len(os.sched_getaffinity(0))
    if not isinstance(threads, int) or isinstance(threads, bool) or threads < 1:
        raise InputError(f"threads is {threads!r}", "give a whole number from 1 on")
    return threads


def _remove(folder: str, owner: int) -> None:
    if os.getpid() == owner:  # not in a process that was forked
        shutil.rmtree(folder, ignore_errors=True)


class _Store:
    """A result file with the runs that follow from one another, and their text. It lives as long as a run in it."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="graze-")
        weakref.finalize(self, _remove, self.folder, os.getpid())
        self.path = os.path.join(self.folder, "results.sqlite")
        self.file = _graze.ResultFile(self.path, write=True)
        self.lock = threading.RLock()
        self.runs = {}  # name -> RunText
        self.models = {}  # name in the text -> compiled part of the model

    def model_name(self, core) -> str:
        """The name under which a copy of a model is kept: as it is now, whatever becomes of it."""
        text = core.text()
        for name, (known, _) in self.models.items():
            if known == text:
                return name
        base = core.name or "model"
        name = base if base not in self.models else f"{base}-{len(self.models) + 1}"
        self.models[name] = (text, core.copied())
        return name

    def free_name(self, kind: str) -> str:
        number = 1
        while f"{kind}{number}" in self.runs:
            number += 1
        return f"{kind}{number}"

    def study(self, runs) -> StudyText:
        return StudyText("python", runs)

    def compute(self, kind: str, keys: dict, called: str, threads, progress):
        """Carries out one more run. Returns its name."""
        with self.lock:
            name = self.free_name(kind)
            run = RunText(name, kind, keys)
            text = self.study([*self.runs.values(), run])
            try:
                models = {known: core for known, (_, core) in self.models.items()}
                study = _graze.Study.parsed(text.text, text.FILE, [], models)
            except InputError as error:
                raise text.told(error, called) from None
            told, close = told_to(progress, "point")
            self.runs[name] = run
            made = RUNS[kind](self, name)
            try:
                reports = study.run(self.file, threads=_threads(threads), only=[name], told=told)
            except KeyboardInterrupt:
                raise Interrupted(made) from None
            except Error as error:
                raise text.told(error, called) from None
            finally:
                close()
            made.report = next(report for report in reports if report["name"] == name)
            if made.report["status"] == "failed":
                failed = RunFailed(made.report["problem"], made.report["remedy"])
                failed.run = made
                raise failed
            return made


class _StoredFile:
    """A result file that was written before, or is being written by another program."""

    def __init__(self, path):
        self.path = path
        self.file = _graze.ResultFile(path, write=False)
        self.lock = threading.RLock()


class Run:
    """A run and its results. `kind`, `name`, `status` ("complete", "unfinished", "failed"); `points` and `samples` are
    tables, `table(what)` is any table of `graze export`, `query(sql)` the rows of a query."""

    kind = ""

    def __init__(self, store, name: str):
        self._store = store
        self.name = name
        self.report = None

    @property
    def _record(self) -> dict:
        for record in self._store.file.runs():
            if record["name"] == self.name:
                return record
        raise InputError(f"the file has no run '{self.name}'", "")

    @property
    def status(self) -> str:
        return self._record["status"]

    @property
    def settings(self) -> str:
        """All settings of the run, as JSON."""
        return self._record["settings"]

    @property
    def model(self) -> Model:
        """The model with the parameters and initial state of the run."""
        return Model(text=self._record["model"])

    def table(self, what: str = "points", *, label: str = "", direction: str = "") -> Table:
        """A table of the run: points, samples, segments, multipliers, minima, ... as `graze export --what`."""
        return Table(*self._store.file.table(what, [self.name], label=label, direction=direction))

    def query(self, sql: str) -> Table:
        """Rows of an SQL query in the result file, whose tables docs/result-file.md describes."""
        return Table(*self._store.file.query(sql, [self.name]))

    @property
    def points(self) -> Table:
        return self.table("points")

    @property
    def samples(self) -> Table:
        return self.table("samples")

    def labels(self) -> dict:
        """How many points have each label."""
        counts = {}
        for label in self.points["label"]:
            counts[label] = counts.get(label, 0) + 1
        return counts

    def plot(self, *, axes=None, over=(), **keys):
        """Draws the run with matplotlib and returns the axes. The keyword arguments are the keys of pictures in studies
        (docs/study-format.md): kind, x, y, samples, at, points, title, ...; over: other runs drawn over this one."""
        from ._plot import draw

        figure, _ = self._picture(over, keys)
        return draw(figure, axes)

    def _picture(self, over, keys):
        shown = {"run": self.name, "over": [run.name for run in over] or None, **keys}
        lines = [f"{toml_key(key)} = {toml_value(value, key)}" for key, value in shown.items() if value is not None]
        try:
            figure, table = _graze.picture(self._store.file, "\n".join(lines) + "\n", "plot()")
        except InputError as error:
            names = [key for key, value in shown.items() if value is not None]
            for one in error.all:
                one.file = f"plot(), {names[one.line - 1]}" if 0 < one.line <= len(names) else "plot()"
                one.line = one.column = 0
            raise
        return figure, Table(*table)

    def study(self) -> str:
        """The text of a study that computes this run and those that it follows from. Models that are not shipped have to
        stand beside it as files."""
        return self._store.study(self._store.runs.values()).text

    def save(self, path) -> None:
        """Writes a result file with this run and all that it follows from; `read_results` reads it. FileError if the file is
        there already."""
        with self._store.lock:
            self._store.file.flush()
            self._store.file.copy_to(os.fspath(path))

    def __repr__(self):
        record = self._record
        return f"<{type(self).__name__} {self.name} of {record['model_name']}: {record['status']}>"

    def _repr_html_(self):
        from ._plot import small_picture

        return small_picture(lambda: self.plot(), repr(self))


class Ensemble(Run):
    """Motions of given length from many initial states or parameters."""

    kind = "simulate"


class Sweep(Run):
    """What motions settle on as a parameter changes step by step."""

    kind = "sweep"


class Basin(Run):
    """What motions settle on from many initial states."""

    kind = "basin"


class Point:
    """An orbit of a run: a special point of a branch, or a regular one.

    Attributes: `label`, `type` ("GR"), `type_words` ("grazing"), `detail`, `parameter` (that is followed), `period`,
    `stable`, `multipliers`, `unphysical`, `error` (estimated, relative), `starts` (segments x states), `durations`,
    `approach_speeds`; and dicts `parameters`, `monitors`.
    """

    def __init__(self, run: "Branch", made: dict):
        self._run = run
        record = run._record
        self._made = made
        self.parameters = dict(zip(run.model.parameters.independent, made.pop("parameters").tolist()))
        self.monitors = dict(zip((name for name, _ in record["values"]), made.pop("monitors").tolist()))

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._made[name]
        except KeyError:
            raise AttributeError(f"an orbit has no attribute {name!r}") from None

    def __dir__(self):
        return [*super().__dir__(), *self._made]

    @property
    def run(self) -> "Branch":
        return self._run

    def _start(self, **more) -> dict:
        return {"run": self._run.name, "point": self.label or str(self.number), **more}

    def motion(self, samples: int = 500) -> Table:
        """The motion along one period: time, states, segment and mode."""
        return _motion_table(self._run, self.label or str(self.number), samples)

    def follow(self, *, along=None, onto=None, threads=None, progress=None, **keys) -> "Branch":
        """The branch through this point along a parameter: `follow(omega=(2, 4))`, or along={"omega": (2, 4)}.
        onto: "same", "other" or "twin" (chosen by the type of the point). Other arguments: see `graze.follow`."""
        along, keys = _along("continue", along, keys, self._run.model)
        return self._run._child("continue", self._start(onto=onto), {"along": along, **keys}, "follow()", threads, progress)

    def switch(self, *, threads=None, progress=None, **keys) -> "Branch":
        """The other branch that leaves here, along the same parameter unless `along` says another: beyond a grazing the
        orbits with one contact more, at a flip those of twice the period, at a branch point the other branch."""
        keys.setdefault("along", self._run._keys().get("along"))
        return self.follow(onto="other", threads=threads, progress=progress, **keys)

    def double(self, *, threads=None, progress=None, **keys) -> "Branch":
        """The orbits of twice the period that leave at a flip."""
        if self.type != "PD":
            raise InputError(f"{self.label or 'the point'} is no flip (PD)", "use switch()")
        return self.switch(threads=threads, progress=progress, **keys)

    def curve(self, *names, along=None, onto=None, threads=None, progress=None, **keys) -> "Curve":
        """The curve of such points in two parameters: `curve("omega", "V")`, or with bounds
        `curve(omega=(2, 4), V=(0, 1))`. Other arguments: see `graze.curve`."""
        if names:
            along = list(names)
        along, keys = _along("curve", along, keys, self._run.model)
        return self._run._child("curve", self._start(onto=onto), {"along": along, **keys}, "curve()", threads, progress)

    def ladder(self, *, along=None, threads=None, progress=None, **keys) -> "Ladder":
        """The sequence of grazings that begins at this one, each with one contact more."""
        along, keys = _along("ladder", along, keys, self._run.model)
        if along is None:
            along = self._run._keys().get("along")
        return self._run._child("ladder", self._start(), {"along": along, **keys}, "ladder()", threads, progress)

    def plot(self, **keys):
        """Draws the orbit; see `Run.plot`."""
        keys.setdefault("kind", "portrait")
        return self._run.plot(points=[self.label or str(self.number)], **keys)

    def __repr__(self):
        stable = "stable" if self.stable else "unstable"
        name = self.label or f"point {self.number}"
        return f"<{name} of {self._run.name}: {self.type_words} at {self.parameter:.9g}, period {self.period:.7g}, {stable}>"

    def _repr_html_(self):
        from ._plot import small_picture

        return small_picture(lambda: self.plot(), repr(self))


def _motion_table(run, point: str, samples: int) -> Table:
    import numpy

    segments = run._store.file.motion(run.name, point, samples)
    states = [one.name for one in run.model.states]
    columns = [numpy.concatenate([one["times"] for one in segments])]
    columns += list(numpy.concatenate([one["states"] for one in segments]).T)
    counts = [len(one["times"]) for one in segments]
    columns.append(numpy.repeat(numpy.arange(1, len(segments) + 1), counts))
    columns.append([one["mode"] for one in segments for _ in one["times"]])
    units = [run.model.time_unit, *(one.unit for one in run.model.states)]
    return Table(["t", *states, "segment", "mode"], columns, [*units, "", ""])


class Branch(Run):
    """A branch of periodic orbits. `branch["GR1"]` and `branch[17]` are points of it, by label or by number; `special`
    lists the special points; iterating goes through them; `points` is the table of all."""

    kind = "continue"

    def _keys(self) -> dict:
        return self._store.runs[self.name].given

    def _child(self, kind, start, keys, called, threads, progress):
        keys = {"model": self._keys()["model"], "start": start, **keys}
        return self._store.compute(kind, keys, called, threads, progress)

    def __getitem__(self, point) -> Point:
        try:
            return Point(self, self._store.file.orbit(self.name, str(point)))
        except InputError as error:
            raise KeyError(str(error)) from None

    @property
    def special(self) -> list:
        """The special points, in the order of the branch."""
        return [Point(self, made) for made in self._store.file.orbits(self.name, special=True)]

    def __iter__(self):
        return iter(self.special)

    def __len__(self):
        return len(self.points)

    def ends(self) -> dict:
        """Why each part of the branch ends."""
        return dict(self.report["ends"]) if self.report else {}

    def __repr__(self):
        labels = [label for label in self.points["label"] if label and not label.startswith("EP")]
        return f"<{type(self).__name__} {self.name} of {self._record['model_name']}: {len(self)} orbits; {' '.join(labels)}>"


class Orbit(Branch):
    """One periodic orbit; it has all attributes of its only point."""

    kind = "orbit"

    @property
    def point(self) -> Point:
        return self[0]

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.point, name)

    def motion(self, samples: int = 500) -> Table:
        """See `Point.motion`."""
        return self.point.motion(samples)

    def follow(self, **keys) -> Branch:
        """See `Point.follow`."""
        return self.point.follow(**keys)


class Curve(Branch):
    """A curve of special points in two parameters."""

    kind = "curve"


class Ladder(Branch):
    """A sequence of grazings, each with one contact more."""

    kind = "ladder"


RUNS = {one.kind: one for one in (Ensemble, Sweep, Basin, Branch, Orbit, Curve, Ladder)}


def _along(kind: str, along, keys: dict, model: Model):
    """Separates parameters that are followed, given as keyword arguments, from the keys of a run."""
    known, followed, rest = keys_of(kind), dict(along) if hasattr(along, "items") else {}, {}
    for name, value in keys.items():
        if name not in known and name in model.parameters:
            followed[name] = value
        else:
            rest[name] = value
    if followed:
        return followed, rest
    return along, rest


def _computed(kind: str, model: Model, keys: dict, called: str, threads, progress):
    if not isinstance(model, Model):
        raise TypeError(f"{called} needs a graze.Model, not {type(model).__name__}")
    if "from_" in keys:
        keys["from"] = keys.pop("from_")
    for name in ("kind", "model"):
        if name in keys:
            raise StudyError(f"{called} has no key '{name}'", "the function and its first argument say it")
    store = _Store()
    return store.compute(kind, {"model": store.model_name(model._core), **keys}, called, threads, progress)


def ensemble(model: Model, *, vary, threads=None, progress=None, **keys) -> Ensemble:
    """Simulates many motions of given length: runs of kind `simulate`."""
    return _computed("simulate", model, {"vary": vary, **keys}, "ensemble()", threads, progress)


def sweep(model: Model, *, vary, threads=None, progress=None, **keys) -> Sweep:
    """What motions settle on as a parameter changes step by step."""
    return _computed("sweep", model, {"vary": vary, **keys}, "sweep()", threads, progress)


def basin(model: Model, *, vary, threads=None, progress=None, **keys) -> Basin:
    """What motions settle on from many initial states."""
    return _computed("basin", model, {"vary": vary, **keys}, "basin()", threads, progress)


def orbit(model: Model, *, threads=None, progress=None, **keys) -> Orbit:
    """The periodic orbit on which the motion from the initial state settles, or that has a given signature."""
    return _computed("orbit", model, keys, "orbit()", threads, progress)


def follow(model: Model, *, along=None, threads=None, progress=None, **keys) -> Branch:
    """A branch of periodic orbits along a parameter: `follow(model, omega=(2, 4))`."""
    along, keys = _along("continue", along, keys, model)
    return _computed("continue", model, {"along": along, **keys}, "follow()", threads, progress)


def curve(point: Point, *names, **keys) -> Curve:
    """The curve of such points in two parameters: see `Point.curve`."""
    return point.curve(*names, **keys)


def ladder(point: Point, **keys) -> Ladder:
    """The sequence of grazings from this one on: see `Point.ladder`."""
    return point.ladder(**keys)


class Study(Mapping):
    """The results of a study: a mapping from names of runs to runs. A file that is still being written shows what is
    there when it is asked."""

    def __init__(self, path):
        path = os.fspath(path)
        if os.path.isdir(path):
            path = os.path.join(path, "results.sqlite")
        self._store = _StoredFile(path)
        self.path = path
        self.reports = []

    def _records(self) -> dict:
        return {record["name"]: record for record in self._store.file.runs()}

    def __getitem__(self, name) -> Run:
        records = self._records()
        if name not in records:
            raise KeyError(f"there is no run {name!r}; there are {', '.join(records)}")
        return RUNS.get(records[name]["kind"], Run)(self._store, name)

    def __iter__(self):
        return iter(self._records())

    def __len__(self):
        return len(self._records())

    def query(self, sql: str) -> Table:
        """Rows of an SQL query, whose tables docs/result-file.md describes."""
        return Table(*self._store.file.query(sql, []))

    def plot(self, picture: str, *, axes=None):
        """Draws a picture of the study, by its name."""
        from ._plot import draw

        return draw(_graze.Study.stored(self._store.file).figure(self._store.file, picture), axes)

    @property
    def pictures(self) -> tuple:
        return tuple(_graze.Study.stored(self._store.file).pictures)

    def __repr__(self):
        runs = ", ".join(f"{name} ({record['kind']}, {record['status']})" for name, record in self._records().items())
        return f"<Study {self.path}: {runs}>"


def read_results(path) -> Study:
    """Reads a result file, or that in the folder of a study."""
    return Study(path)


def run_study(study, *, output, only=(), set=None, threads=None, progress=None) -> Study:
    """Carries out a study: the name of a shipped one, or a file. Results are kept in the folder `output`, as they come;
    what is there already is not computed again. Returns them."""
    try:
        read = _graze.Study.loaded(os.fspath(study), list((set or {}).items()))
    except InputError as error:
        from ._errors import as_kind

        raise as_kind(error, StudyError) from None
    os.makedirs(output, exist_ok=True)
    path = os.path.join(os.fspath(output), "results.sqlite")
    told, close = told_to(progress, "point")
    try:
        file = _graze.ResultFile(path, write=True)
        reports = read.run(file, threads=_threads(threads), only=[only] if isinstance(only, str) else list(only), told=told)
    except KeyboardInterrupt:
        raise Interrupted(Study(path)) from None
    finally:
        close()
    result = Study(path)
    result.reports = reports
    return result


def studies() -> tuple:
    """Names of the studies that come with graze."""
    return tuple(_graze.shipped_studies())
