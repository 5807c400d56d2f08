"""Runs: computations whose results are kept in a file, as those of studies are."""

from __future__ import annotations

import contextlib
import functools
import itertools
import os
import re
import shutil
import tempfile
import threading
import weakref
import zlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Iterable, Iterator, List, Optional, Tuple, Union

from . import _graze
from ._analyses import PointAnalyses
from ._errors import (Error, FileError, InputError, Interrupted, OrderError, RunFailed, StudyError, WorkersLost,
                      as_kind)
from ._keywords import CallText, RunText, keys_of, study_text, takes_keys_of, toml_key, toml_value
from ._model import Model
from ._progress import Progress, told_to
from ._table import Table

if TYPE_CHECKING:
    import numpy

    from ._plot import Figure

Path = Union[str, "os.PathLike[str]"]
Source = Union[Model, "Run", "Point"]
"""Where a run starts: from the initial state of a model, from another run, or from a point of a branch."""
Runs = Union["Run", Iterable["Run"]]
"""A run, or several."""
Along = Union[None, str, Mapping[str, Any]]
"""What is followed: parameters with their bounds, {"omega": (2, 4)}."""
At = Optional[Mapping[str, float]]
"""The value that chooses the nearest point of a run, {"omega": 2.5}."""

_MOST_RUNS = 16  # in one file: what is written to it costs more, the more runs it has


def _threads(threads) -> int:
    if threads is None:
        return len(os.sched_getaffinity(0))
    if not isinstance(threads, int) or isinstance(threads, bool) or threads < 1:
        raise InputError(f"threads is {threads!r}", "give a whole number from 1 on")
    return threads


def _carried_out(study, file, *, only, threads, progress, executor) -> list:
    """Carries out runs of a study. Returns reports."""
    threads = _threads(threads)
    parts = exchange = None
    if executor is not None:
        from ._executors import Parts

        parts = Parts(executor)
        exchange = parts.exchange
    told, close = told_to(progress, "point")

    def look(state):
        parts.look()
        if told:
            told(state)

    try:
        return study.run(file, threads=threads, only=only, told=look if parts else told, parts=exchange)
    finally:
        if parts:
            parts.close()
        close()


@contextlib.contextmanager
def _writing(path):
    """Errors of the system while something is written, as those of the package."""
    try:
        yield
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"'{error.filename or os.fspath(path)}' cannot be written: {error.strerror or error}",
                        "choose another place, or change the permissions") from None


def _remove(folder: str, owner: int) -> None:
    if os.getpid() == owner:  # not in a process that was forked
        shutil.rmtree(folder, ignore_errors=True)


@functools.lru_cache(maxsize=None)
def _empty_file() -> bytes:
    """A result file without runs. To copy it is quicker than to make one, for which SQLite waits for the disk."""
    with tempfile.TemporaryDirectory(prefix="graze-") as folder:
        path = os.path.join(folder, "empty.sqlite")
        _graze.ResultFile(path, write=True)
        with open(path, "rb") as file:
            return file.read()


def _write_temporary(path: str, contents: bytes) -> None:
    """Writes a result file that is to be written further. Bytes 18 and 19 say that SQLite keeps a write-ahead log, as it does
    for all result files that are written, so that it need not change them and wait for the disk."""
    with _writing(path), open(path, "wb") as file:
        file.write(contents[:18] + b"\2\2" + contents[20:])


_ALL = weakref.WeakSet()  # results that are open in this process, for those that are forked from it


def _after_fork() -> None:
    for one in list(_ALL):
        one._forked()


os.register_at_fork(after_in_child=_after_fork)


class _Results:
    """The results in a file. It is read by a connection of its own, so that it can be read while it is written."""

    def __init__(self, path: str):
        self.path = path
        self.runs = {}  # name -> RunText, of runs that were asked for by calls
        self.models = {}  # name in these texts -> (text, compiled part of the model)
        self._handle = None
        self._reading = threading.RLock()
        _ALL.add(self)

    @property
    def file(self):
        """The file, for reading."""
        with self._reading:
            if self._handle is None:
                self._handle = _graze.ResultFile(self.path, write=False)
            return self._handle

    def read(self, what: str, *arguments, **keys):
        """Calls a function that reads the file; one thread at a time does."""
        with self._reading:
            return getattr(self.file, what)(*arguments, **keys)

    def copy(self, path: str, names=()) -> None:
        """Writes a result file with these runs and those that they need, or with all."""
        if os.path.lexists(path):
            raise FileError(f"the file {path} is there already", "choose another name, or remove it first")
        self._copy_into(path, names)

    def _copy_into(self, path: str, names=()) -> None:
        file = _graze.ResultFile(path, write=True)
        with self._reading:
            file.take_runs(self.file, list(names))
            _graze.Study.stored(file if names else self.file).store(file)

    def contents(self) -> bytes:
        with tempfile.TemporaryDirectory(prefix="graze-") as folder:
            path = os.path.join(folder, "copy.sqlite")
            _write_temporary(path, _empty_file())
            self._copy_into(path)
            with open(path, "rb") as file:
                return file.read()

    def _forked(self) -> None:
        # A connection must not be used, and not even be closed, by two processes.
        if self._handle is not None:
            _graze.never_destroy(self._handle)
        self._handle = None
        self._reading = threading.RLock()

    def resume(self, made: "Run", threads, progress, executor):
        raise InputError(f"run '{made.name}' belongs to the file {self.path}, which is only read",
                         "carry out its study again with the same output: what is there is not computed again")

    def __reduce__(self):
        models = {name: text for name, (text, _) in self.models.items()}
        return _restored_store, (zlib.compress(self.contents(), 1), self.runs, models)

    def __deepcopy__(self, memo):
        restored, arguments = self.__reduce__()
        return restored(*arguments)


def _restored_store(contents: bytes, runs: dict, models: dict) -> "_Store":
    store = _Store(zlib.decompress(contents))
    store.runs.update(runs)
    store.models.update((name, (text, _graze.Model.parsed(text, "model"))) for name, text in models.items())
    return store


class _StoredFile(_Results):
    """A result file that was written before, or is being written by another program."""

    def __init__(self, path):
        super().__init__(path)
        self.file  # opened now, so that a missing file is told now


class _Store(_Results):
    """A result file of calls: runs that follow from one another. It lives as long as a run in it."""

    writer = None  # the file, for writing; None in a process that was forked since it was opened

    def __init__(self, contents: Optional[bytes] = None):
        self.folder = self._new_folder()
        super().__init__(os.path.join(self.folder, "results.sqlite"))
        _write_temporary(self.path, _empty_file() if contents is None else contents)
        self._open()

    def _new_folder(self) -> str:
        with _writing("a temporary folder"):
            folder = tempfile.mkdtemp(prefix="graze-")
        weakref.finalize(self, _remove, folder, os.getpid())
        return folder

    def _open(self) -> None:
        self.lock = threading.RLock()
        self.busy = False
        self.writer = _graze.ResultFile(self.path, write=True)
        self._study = None  # of all runs of the file, once it is needed
        self._taken = weakref.WeakKeyDictionary()  # results -> names of runs there -> names here

    def _forked(self) -> None:
        super()._forked()
        if self.writer is not None:
            _graze.never_destroy(self.writer)
        self.writer = None
        self.lock = threading.RLock()

    def _own(self) -> None:
        """Makes the file one that this process may write, if it was forked since."""
        if self.writer is None:
            folder = self._new_folder()
            path = os.path.join(folder, "results.sqlite")
            _write_temporary(path, _empty_file())
            self._copy_into(path)
            self.folder, self.path, self._handle = folder, path, None
            self._open()

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
        there = {*self.runs, *self.read("names")}
        return next(name for name in (f"{kind}{number}" for number in itertools.count(1)) if name not in there)

    def take(self, run: "Run") -> str:
        """The name that a run of any results has here, to where it is copied with what it needs."""
        if run._store is self:
            return run.name
        with self.lock:
            known = self._taken.setdefault(run._store, {})
            if run.name not in known:
                self._own()
                with run._store._reading:
                    names = self.writer.take_runs(run._store.file, [run.name])
                self._study = None
                known.update(names)
                for name, text in run._store.runs.items():
                    if name in names and names[name] not in self.runs:
                        model = run._store.models.get(text.given.get("model"))
                        self.runs[names[name]] = text.renamed(names[name], names, model and self.model_name(model[1]))
            return known[run.name]

    def needed(self, names) -> List[str]:
        """Runs and those that they need, in the order of computing."""
        wanted = set()

        def want(name):
            if name not in wanted:
                wanted.add(name)
                for need in self.runs[name].needs() if name in self.runs else ():
                    want(need)

        for name in names:
            want(name)
        return [name for name in dict.fromkeys([*self.runs, *names, *sorted(wanted)]) if name in wanted]

    def compute(self, kind: str, keys: dict, called: str, threads, progress, executor=None, folder: str = ""):
        """Carries out one more run. Returns it."""
        _threads(threads)
        with self.lock:
            self._require_idle()
            self._own()
            name = self.free_name(kind)
            run = RunText(name, kind, keys, folder)
            text = CallText(run, called)
            models = {known: core for known, (_, core) in self.models.items()}
            try:
                if self._study is None and self.read("names"):
                    self._study = _graze.Study.stored(self.writer)
                if self._study is None:
                    study = _graze.Study.parsed(text.text, text.file, [], models)
                else:
                    study = self._study.further(text.text, text.file, models)
            except InputError as error:
                raise text.told(error) from None
            self._study = study.kept_in(self.writer)
            self.runs[name] = run
            return self._carry_out(text, RUNS[kind](self, name), threads, progress, executor)

    def resume(self, made: "Run", threads, progress, executor):
        with self.lock:
            self._require_idle()
            self._own()
            if self._study is None:
                self._study = _graze.Study.stored(self.writer)
            text = CallText(self.runs.get(made.name, RunText(made.name, made.kind, {})), "resume()")
            return self._carry_out(text, made, threads, progress, executor)

    def _require_idle(self) -> None:
        if self.busy:
            raise OrderError("another run is being computed, and this one would be kept in the same file",
                             "begin it when that one has ended, not in the function that is told of its progress")

    def _carry_out(self, text: CallText, made: "Run", threads, progress, executor):
        self.busy = True
        try:
            reports = _carried_out(self._study, self.writer, only=[made.name], threads=threads, progress=progress,
                                   executor=executor)
        except KeyboardInterrupt:
            raise Interrupted(made) from None
        except WorkersLost as error:
            error.run = made
            raise
        except Error as error:
            raise text.told(error) from None
        finally:
            self.busy = False
        made.report = next(report for report in reports if report["name"] == made.name)
        if made.report["status"] == "interrupted":
            raise Interrupted(made)
        if made.report["status"] != "complete":
            failed = RunFailed(text.words(made.report["problem"]), text.words(made.report["remedy"]))
            failed.run = made
            raise failed
        return made


class Run:
    """A run and its results.

    `name` and `kind`; `status`: "complete", "unfinished" or "failed"; `points` and `samples` are tables, `table(what)` is
    any table of `graze export`, `query(sql)` the rows of a query. `report` tells what was done, of a run that was carried
    out by this object (else None). Runs can be copied and pickled: results and all go with them.
    """

    kind = ""

    def __init__(self, store: _Results, name: str) -> None:
        self._store = store
        self.name = name
        self.report: Optional[dict] = None
        self._kept = None  # record of a complete run of calls, which does not change, and its model

    @property
    def _record(self) -> dict:
        if self._kept is not None:
            return self._kept[0]
        record = self._store.read("run", self.name)
        if record is None:
            raise InputError(f"the file has no run '{self.name}'", "")
        if record["status"] == "complete" and isinstance(self._store, _Store):
            self._kept = record, _graze.Model.parsed(record["model"], "model")
        return record

    @property
    def _model(self):
        """The compiled part of the model, not to be changed."""
        record = self._record
        return self._kept[1] if self._kept is not None else _graze.Model.parsed(record["model"], "model")

    @property
    def status(self) -> str:
        """"complete", "unfinished" or "failed"."""
        return self._record["status"]

    @property
    def failure(self) -> str:
        """Why the run failed, and what to do; empty if it did not."""
        return re.sub(r"(\w+\(\)):\d+:\d+: ", r"\1: ", self._record["failure"])

    @property
    def settings(self) -> str:
        """All settings of the run, as JSON."""
        return self._record["settings"]

    @property
    def model(self) -> Model:
        """A copy of the model, with the parameters and initial state of the run."""
        return Model._of(self._model.copied())

    @property
    def units(self) -> dict:
        """Units of what varies, of the states and of the values, by name; only those that are not empty."""
        record = self._record
        return {name: unit for part in ("states", "coordinates", "values") for name, unit in record[part] if unit}

    def table(self, what: str = "points", *, label: str = "", direction: str = "") -> Table:
        """A table of the run: points, samples, segments, multipliers, minima, ... as `graze export --what`.

        label, direction: only points with this label (of a branch also of this type), or of this direction. Raises
        InputError, which names the tables, for another word.
        """
        return Table(*self._store.read("table", what, [self.name], label=label, direction=direction))

    def query(self, sql: str) -> Table:
        """Rows of an SQL query in the result file, whose tables docs/result-file.md describes. InputError for what is no
        query, or changes something."""
        return Table(*self._store.read("query", sql, [self.name]))

    @property
    def points(self) -> Table:
        """A row for each point, or orbit."""
        return self.table("points")

    @property
    def samples(self) -> Table:
        """A row for each sample."""
        return self.table("samples")

    def labels(self) -> dict:
        """How many points have each label; of branches, how many special points are of each type."""
        return dict(self._store.read("summary", self.name)["labels"])

    def plot(self, *, axes: Any = None, also: Runs = (), over: Runs = (), **keys: Any) -> Any:
        """Draws the run with matplotlib, and returns the axes: one, or an array with one for each panel.

        axes: where to draw: one axes, or a sequence of as many as there are panels; pyplot is not touched then. Without
            it a figure of pyplot is made, of the size and arrangement of the program's picture.
        also: other runs, such as branches and curves, drawn in the same panels, each in a colour of its own.
        over: runs whose points are drawn over those of this one, as measured ones over computed ones.
        Other arguments are the keys of pictures in studies (docs/study-format.md): kind ("bifurcation", "branch",
            "basin", "map", "spectrum", "history", "portrait", "poincare", "regression", "scatter", "residuals"; chosen by
            the kind of run), x, y (a name or a list: one panel each), samples, directions, at, points, x_range, y_range,
            logarithmic, title, names, x_label, y_label, size (in mm), font, grey, ...

        Raises InputError for keys and values that pictures do not have, and for a wrong number of axes.
        """
        from ._plot import draw

        return draw(self._picture(keys, over, also)[0], axes)

    def figure(self, *, also: Runs = (), over: Runs = (), **keys: Any) -> "Figure":
        """The data that `plot` draws: panels with series of points, labels and texts. The arguments are those of
        `plot`."""
        from ._plot import Figure

        return Figure(self._picture(keys, over, also)[0])

    def _picture(self, keys, over=(), also=()):
        for key in ("run", "runs", "format"):
            if key in keys:
                remedy = "save the figure: axes.figure.savefig(...)" if key == "format" else "name other runs by also="
                raise InputError(f"plot() has no key '{key}'", remedy, f"plot(), {key}")
        also, over = _drawn_runs(also, "also"), _drawn_runs(over, "over")
        store, (name, *others) = self._together([self, *also, *over])
        shown = {"runs": [name, *others[:len(also)]], "over": others[len(also):] or None, **keys}
        if isinstance(keys.get("y"), str):
            shown["y"] = [keys["y"]]
        shown = {key: value for key, value in shown.items() if value is not None}
        lines = [f"{toml_key(key)} = {toml_value(value, key)}" for key, value in shown.items()]
        try:
            with store._reading:
                figure, table = _graze.picture(store.file, "\n".join(lines) + "\n", "plot()")
        except InputError as error:
            names = [("also" if also else "") if key == "runs" else key for key in shown]
            for one in error.all:
                key = names[one.line - 1] if 0 < one.line <= len(names) else ""
                one.file = f"plot(), {key}" if key else "plot()"
                one.line = one.column = 0
            raise
        return figure, Table(*table)

    @staticmethod
    def _together(runs: list):
        """Results that have all of these runs, and their names there."""
        first = runs[0]._store
        if all(run._store is first or os.path.realpath(run._store.path) == os.path.realpath(first.path) for run in runs):
            return first, [run.name for run in runs]
        store = _Store()
        return store, [store.take(run) for run in runs]

    def _small_picture(self):
        """What is drawn in notebooks, where that is quick."""
        return self._picture({"size": 110})[0] if self._record["points"] <= 5000 else None

    def resume(self, *, threads: Optional[int] = None, executor: Any = None, progress: Progress = None) -> "Run":
        """Goes on with a run that was interrupted, or whose executor lost its workers: what was computed is kept, and the
        results are those of a run without interruption, to the last bit. Returns the run."""
        return self._store.resume(self, threads, progress, executor)

    def study(self) -> str:
        """The text of a study that computes this run and those that it follows from. Its models and other files have to
        stand beside it: `write_study` writes all. InputError for runs that were read from a file."""
        return study_text("python", self._texts())

    def _texts(self) -> List[RunText]:
        store = self._store
        names = store.needed([self.name]) if isinstance(store, _Store) else [self.name]
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
        folder = os.fspath(folder)
        texts = self._texts()
        path = os.path.join(folder, "study.toml")
        with _writing(folder):
            os.makedirs(folder, exist_ok=True)
            written = []
            for run in texts:
                keys = dict(run.given)
                if "model" in keys:
                    keys["model"] = _written_model(folder, keys["model"], self._store.models[keys["model"]][0])
                for key in ("files", "table"):
                    if key in keys:
                        _copy_inputs(keys[key], run.folder, folder)
                written.append(RunText(run.name, run.kind, keys))
            with open(path, "w", encoding="utf-8") as file:
                file.write(study_text("python", written))
        return path

    def save(self, path: Path) -> None:
        """Writes a result file with this run and those that it follows from; `read_results` reads it, and `graze` too.
        FileError if the file is there already."""
        self._store.copy(os.fspath(path), [self.name])

    def __copy__(self):
        other = type(self)(self._store, self.name)
        other.report = self.report
        return other

    def __reduce__(self):
        return _restored_run, (self._store, self.name, self.report)

    def __repr__(self):
        record = self._record
        return f"<{type(self).__name__} {self.name} of {record['model_name']}: {record['status']}>"

    def _repr_html_(self):
        from ._plot import small_picture

        return small_picture(self._small_picture, repr(self))


def _drawn_runs(runs, key: str) -> list:
    runs = [runs] if isinstance(runs, Run) or not hasattr(runs, "__iter__") else list(runs)
    runs = [run for run in runs if run is not None]
    for run in runs:
        if not isinstance(run, Run):
            raise InputError(f"{key} has an object of type {type(run).__name__}", "give runs", f"plot(), {key}")
    return runs


def _restored_run(store: _Store, name: str, report) -> Run:
    run = RUNS[store.read("run", name)["kind"]](store, name)
    run.report = report
    return run


def _written_model(folder: str, name: str, text: str) -> str:
    """What a study calls a model: the name of a shipped one that is the same, or the file to which it is written."""
    try:
        if name in dict(_graze.shipped_models()) and _graze.Model.loaded(name).text() == text:
            return name
    except InputError:
        pass
    file = "".join(c if c.isalnum() or c in "._-" else "_" for c in name) + ".toml"
    file = f"model-{file}" if file in ("study.toml",) or file.startswith(".") else file
    with open(os.path.join(folder, file), "w", encoding="utf-8") as out:
        out.write(text)
    return f"./{file}"


def _copy_inputs(named, source: str, folder: str) -> None:
    """Copies files that a run reads to the same relative places in a folder."""
    import glob

    if hasattr(named, "items"):
        named = [one for some in named.values() for one in ([some] if isinstance(some, str) else some)]
    for pattern in [named] if isinstance(named, (str, os.PathLike)) else named:
        for path in glob.glob(os.path.join(glob.escape(source), os.fspath(pattern))):
            target = os.path.join(folder, os.path.relpath(path, source or "."))
            os.makedirs(os.path.dirname(target) or ".", exist_ok=True)
            if not (os.path.exists(target) and os.path.samefile(path, target)):
                shutil.copyfile(path, target)


class Ensemble(Run):
    """Motions of given length from many initial states or parameters."""

    kind = "simulate"


class Sweep(Run):
    """What motions settle on as a parameter changes step by step."""

    kind = "sweep"


class Basin(Run):
    """What motions settle on from many initial states."""

    kind = "basin"


class Record(Run):
    """Measured records: a point for each record, its rows as `samples`."""

    kind = "record"

    def __len__(self):
        return self._store.read("count", self.name)

    def __bool__(self):
        return True

    def __repr__(self):
        count = len(self)
        values = ", ".join(name for name, _ in self._record["values"])
        return f"<Record {self.name}: {count} {'record' if count == 1 else 'records'} of {values}; {self.status}>"


class Identification(Run):
    """Parameters found from records.

    `estimates` is a table of the numbers with their errors; `identification["zeta"]` is the value of one, `errors` a dict
    of their standard errors; `covariance` is a matrix; `measured`, `fitted` and `residuals` are tables.
    """

    kind = "identify"

    @property
    def estimates(self) -> Table:
        """A row for each number: name, unit, value, (standard) error, low and high (ends of the interval of 95 %), freedom
        (degrees of freedom of the error) and note."""
        return self.table("estimates")

    @property
    def values(self) -> dict:
        """The numbers that were found, by name."""
        table = self.estimates
        return dict(zip(table["name"], map(float, table["value"])))

    @property
    def errors(self) -> dict:
        """The standard errors of these numbers, by name; NaN where one is not known."""
        table = self.estimates
        return dict(zip(table["name"], map(float, table["error"])))

    def __getitem__(self, name: str) -> float:
        values = self.values
        if name not in values:
            raise KeyError(f"there is no estimate {name!r}; there are {', '.join(values)}")
        return values[name]

    @property
    def covariance(self) -> "numpy.ndarray":
        """The covariance matrix of the numbers, in the order of `estimates`: NaN for numbers whose error is not known, 0
        where no covariance of two numbers is known."""
        import numpy

        matrix = self._store.read("covariance", self.name)
        unknown = numpy.isnan(self.estimates["error"])
        matrix[unknown, :] = matrix[:, unknown] = numpy.nan
        return matrix

    def _sampled(self, sampling: str) -> Table:
        import numpy

        table = self.samples
        chosen = table.rows(numpy.array([one == sampling for one in table["sampling"]], dtype=bool))
        shown = [name for name, _ in self._record["values"]]
        return Table(shown, [chosen[name] for name in shown], [chosen.units.get(name, "") for name in shown])

    @property
    def measured(self) -> Table:
        """What the records say: the number of the `record`, then the abscissa, such as the time t, and the values."""
        return self._sampled("measured")

    @property
    def fitted(self) -> Table:
        """The same columns as `measured`, by the numbers found."""
        return self._sampled("fitted")

    @property
    def residuals(self) -> Table:
        """The same columns: values measured less values fitted."""
        return self._sampled("residual")

    @property
    def found_model(self) -> Model:
        """A copy of the model with the parameters that were found."""
        model = self.model
        known = model.parameters.independent
        for name, value in self.values.items():
            if name in known:
                model.parameters[name] = value
        return model

    def __repr__(self):
        table = self.estimates
        shown = [f"{name} = {value:.6g}" + (f" +- {error:.2g}" if error == error and error > 0 else "")
                 + (f" {unit}" if unit else "")
                 for name, value, error, unit in zip(table["name"], table["value"], table["error"], table["unit"])]
        if len(shown) > 8:
            shown[8:] = [f"and {len(shown) - 8} more"]
        return f"<Identification {self.name} of {self._record['model_name']}: {', '.join(shown) or self.status}>"


# Keys that have no effect where a run starts from an orbit.
_OF_SETTLING = ("start", "from", "mode", "signature", "table", "section", "bounds", "cycles", "largest_period", "recurrence",
                "disturbance", "longest_return", "order", "largest_step")


class Point(PointAnalyses):
    """An orbit of a run: a special point of a branch, or a regular one.

    Attributes: `label` ("GR1"; empty for regular points), `number`, `type` ("GR"), `type_words` ("grazing"), `detail`,
    `parameter` (value of the one that is followed), `period`, `stable`, `multipliers` (complex, the largest first; empty
    where they are not defined), `half_multipliers` of symmetric orbits, `unphysical`, `error` (estimated, relative),
    `starts` (segments x states), `durations` and `approach_speeds` (segments); and dicts `parameters`, `monitors`.
    """

    def __init__(self, run: "Branch", made: dict) -> None:
        self._run = run
        record = run._record
        self._made = made
        self.parameters = dict(zip(run._model.independent_parameters(), made.pop("parameters").tolist()))
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
        """The run that the orbit belongs to."""
        return self._run

    @property
    def model(self) -> Model:
        """A copy of the model with the parameters of the orbit, and its first state and mode as the initial ones:
        `simulate(point.model)` goes along the orbit."""
        model = Model._of(self._run._model.copied())
        for name, value in self.parameters.items():
            model.parameters[name] = value
        for name, value in zip(list(model.initial), self.starts[0].tolist()):
            model.initial[name] = value
        model.initial_mode = model.modes[self.modes[0]]
        return model

    def _name(self) -> str:
        return self.label or str(self.number)

    def _start(self, **more) -> dict:
        return {"run": self._run, "point": self._name(), **more}

    def _child(self, kind, keys, called, threads, progress, onto=None):
        return _computed(kind, self._run, {"start": self._start(onto=onto), **keys}, called, threads, progress)

    @takes_keys_of("continue", *_OF_SETTLING)
    def follow(self, *, along: Along = None, onto: Optional[str] = None, threads: Optional[int] = None,
               progress: Progress = None, **keys: Any) -> "Branch":
        """The branch through this point along a parameter: `follow(omega=(2, 4))`, or along={"omega": (2, 4)}.

        onto: "same", "other" or "twin" (chosen by the type of the point). Raises RunFailed where no orbit is found.
        """
        along, keys = _along("continue", along, keys, self._run._model)
        return self._child("continue", {"along": along, **keys}, "follow()", threads, progress, onto)

    @takes_keys_of("continue", *_OF_SETTLING)
    def switch(self, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
               **keys: Any) -> "Branch":
        """The other branch that leaves here, along the same parameter unless `along` says another: beyond a grazing the
        orbits with one contact more, at a flip those of twice the period, at a branch point the other branch, where a
        symmetry is lost the orbits without it."""
        along, keys = _along("continue", along, keys, self._run._model)
        along = self._along_as_before() if along is None else along
        return self._child("continue", {"along": along, **keys}, "switch()", threads, progress, "other")

    @takes_keys_of("continue", *_OF_SETTLING)
    def double(self, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
               **keys: Any) -> "Branch":
        """The orbits of twice the period that leave at a flip. InputError for other points."""
        if self.type != "PD":
            raise InputError(f"{self._name()} is no flip (PD) but {self.type_words}", "use switch()")
        along, keys = _along("continue", along, keys, self._run._model)
        along = self._along_as_before() if along is None else along
        return self._child("continue", {"along": along, **keys}, "double()", threads, progress, "other")

    @takes_keys_of("continue", *_OF_SETTLING)
    def twin(self, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
             **keys: Any) -> "Branch":
        """The branch through the symmetric image of this orbit, under the symmetry that the model declares."""
        along, keys = _along("continue", along, keys, self._run._model)
        along = self._along_as_before() if along is None else along
        return self._child("continue", {"along": along, **keys}, "twin()", threads, progress, "twin")

    def image(self, *, threads: Optional[int] = None, progress: Progress = None) -> "Orbit":
        """The symmetric image of this orbit, under the symmetry that the model declares."""
        return self._child("orbit", {}, "image()", threads, progress, "twin")

    @takes_keys_of("curve", *_OF_SETTLING)
    def curve(self, *names: str, along: Along = None, onto: Optional[str] = None, threads: Optional[int] = None,
              progress: Progress = None, **keys: Any) -> "Curve":
        """The curve of such points in two parameters: `curve(omega=(2, 4), V=(0, 1))`, with the bounds of both.

        onto: which of several curves that meet here, by the type of its points, as "PD".
        """
        if names:
            raise InputError(f"the bounds of {' and '.join(map(str, names))} are missing",
                             f"give them: curve({', '.join(f'{name}=(LEAST, GREATEST)' for name in names)})")
        along, keys = _along("curve", along, keys, self._run._model)
        return self._child("curve", {"along": along, **keys}, "curve()", threads, progress, onto)

    @takes_keys_of("ladder", *_OF_SETTLING)
    def ladder(self, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
               **keys: Any) -> "Ladder":
        """The sequence of grazings that begins at this one, each with one contact more, up to the onset of chatter."""
        along, keys = _along("ladder", along, keys, self._run._model)
        along = self._along_as_before() if along is None else along
        return self._child("ladder", {"along": along, **keys}, "ladder()", threads, progress)

    def _along_as_before(self):
        """The parameter that the branch follows, with its bounds; of a curve or an orbit: nothing."""
        import json

        record = self._run._record
        text = self._run._store.runs.get(self._run.name)
        if record["kind"] not in ("continue", "ladder"):
            return None
        if text is not None and text.given.get("along") is not None:
            return text.given["along"]
        settings = json.loads(record["settings"])
        name = record["coordinates"][0][0]
        if settings.get("least") is None or settings.get("greatest") is None:
            return name
        return {name: [settings["least"], settings["greatest"]]}

    def plot(self, **keys: Any) -> Any:
        """Draws the orbit: kind="portrait" (with contacts marked) or "history". Other arguments: see `Run.plot`."""
        keys.setdefault("kind", "portrait")
        return self._run.plot(points=[self._name()], **keys)

    def plot_multipliers(self, *, axes: Any = None) -> Any:
        """Draws the multipliers in the complex plane, with the unit circle. Returns the axes."""
        from ._plot import draw_multipliers

        name = self.label or f"point {self.number}"
        return draw_multipliers(self.multipliers, f"{name} of {self._run.name}: {self.type_words}", axes)

    def __eq__(self, other):
        if not isinstance(other, Point):
            return NotImplemented
        return self._run._record["fingerprint"] == other._run._record["fingerprint"] and self.number == other.number

    def __hash__(self):
        return hash((self._run._record["fingerprint"], self.number))

    def __reduce__(self):
        return _restored_point, (self._run, self.number)

    def __copy__(self):
        return self

    def __repr__(self):
        stable = "stable" if self.stable else "unstable"
        if isinstance(self._run, Orbit):
            return f"<Orbit {self._run.name} of {self._run._record['model_name']}: period {self.period:.7g}, {stable}>"
        where = f"{self.type_words} at {self._run.parameter} = {self.parameter:.9g}"
        return f"<{self.label or f'point {self.number}'} of {self._run.name}: {where}, period {self.period:.7g}, {stable}>"

    def _repr_html_(self):
        from ._plot import small_picture

        keys = {"kind": "portrait", "points": [self._name()], "size": 110}
        return small_picture(lambda: self._run._picture(keys)[0], repr(self))


def _restored_point(run: "Branch", number: int) -> Point:
    return run[number]


class Branch(Run):
    """A branch of periodic orbits.

    `branch["GR1"]` and `branch[17]` are orbits of it, by label or by number (-1: the last one); iterating goes through the
    special points, which `special` lists; `orbits()` are all orbits, `points` their table, `multipliers` an array. A
    branch is followed further from its points: `branch["GR1"].switch()`, `branch["PD1"].double()`, `branch.at(omega=2.5)`.
    """

    kind = "continue"

    def __getitem__(self, point) -> Point:
        if isinstance(point, slice):
            return self.orbits()[point]
        if isinstance(point, bool) or not (isinstance(point, str) or hasattr(point, "__index__")):
            raise KeyError(f"an orbit is named by its label or number, not by {point!r}")
        if not isinstance(point, str):
            number = point.__index__()
            point = str(number if number >= 0 else len(self) + number)
        try:
            return Point(self, self._store.read("orbit", self.name, point))
        except InputError as error:
            raise KeyError(str(error)) from None

    @property
    def special(self) -> List[Point]:
        """The special points, in the order of the branch."""
        return [Point(self, made) for made in self._store.read("orbits", self.name, special=True)]

    def orbits(self) -> List[Point]:
        """All orbits, in the order of their numbers."""
        return [Point(self, made) for made in self._store.read("orbits", self.name, special=False)]

    def __iter__(self) -> Iterator[Point]:
        return iter(self.special)

    def __contains__(self, point) -> bool:
        try:
            self[point]
        except KeyError:
            return False
        return True

    def __len__(self) -> int:
        return self._store.read("count", self.name)

    @property
    def segments(self) -> Table:
        """A row for each segment of each orbit."""
        return self.table("segments")

    @property
    def samples(self) -> Table:
        """The same as `segments`: orbits have no samples."""
        return self.segments

    @property
    def parameter(self) -> str:
        """The name of the parameter that is followed."""
        return self._record["coordinates"][0][0]

    @property
    def multipliers(self) -> "numpy.ndarray":
        """Multipliers of all orbits: complex, orbits x multipliers, the largest first; NaN where one is not defined."""
        return self._multipliers("multipliers")

    @property
    def half_multipliers(self) -> "numpy.ndarray":
        """The same for the maps over half a period, of orbits that are their own symmetric images."""
        return self._multipliers("half_multipliers")

    def _multipliers(self, what: str):
        import numpy

        table = self.table(what)
        point = numpy.asarray(table["point"], dtype=int)
        position = numpy.asarray(table["position"], dtype=int)
        result = numpy.full((len(self), int(position.max(initial=-1)) + 1), complex("nan+nanj"))
        result.real[point, position] = table["real"]
        result.imag[point, position] = table["imaginary"]
        return result

    def at(self, *, threads: Optional[int] = None, progress: Progress = None, **values: float) -> "Orbit":
        """The orbit of the branch at exactly one value of a parameter: the nearest one, moved there: `at(omega=2.5)`.
        RunFailed if no orbit is found there."""
        if len(values) != 1:
            raise InputError(f"{len(values)} values are given", "give the value of one parameter: at(omega=2.5)")
        known = self._model.independent_parameters()
        for name in values:
            if name not in known:
                raise InputError(f"the model has no independent parameter {name!r}", f"it has {', '.join(known)}")
        return _computed("orbit", self, {"start": {"run": self, "at": values}}, "at()", threads, progress)

    def ends(self) -> dict:
        """Why each part of the branch ends."""
        return dict(self._store.read("summary", self.name)["ends"])

    def __repr__(self):
        labels = [one["label"] for one in self._store.read("orbits", self.name, special=True)]
        shown = " ".join(label for label in labels if not label.startswith("EP"))
        return f"<{type(self).__name__} {self.name} of {self._record['model_name']}: {len(self)} orbits; {shown}>"


class Orbit(Branch):
    """One periodic orbit; it has all attributes and methods of its only point."""

    kind = "orbit"

    @property
    def point(self) -> Point:
        """The orbit as a point, as those of branches are."""
        return self[0]

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.point, name)

    @property
    def multipliers(self) -> "numpy.ndarray":
        """The multipliers: complex, the largest first."""
        return self.point.multipliers

    @property
    def half_multipliers(self) -> "numpy.ndarray":
        """Those of the map over half a period, of an orbit that is its own symmetric image."""
        return self.point.half_multipliers

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

    def __repr__(self):
        return repr(self.point) if len(self) else f"<Orbit {self.name}: {self.status}>"


class Curve(Branch):
    """A curve of special points in two parameters."""

    kind = "curve"


class Ladder(Branch):
    """A sequence of grazings, each with one contact more."""

    kind = "ladder"


RUNS = {one.kind: one for one in (Ensemble, Sweep, Basin, Branch, Orbit, Curve, Ladder, Record, Identification)}


def _along(kind: str, along, keys: dict, core):
    """Separates parameters that are followed, given as keyword arguments, from the keys of a run."""
    known, parameters = keys_of(kind), [one["name"] for one in core.parameters]
    followed, rest = dict(along) if hasattr(along, "items") else {}, {}
    for name, value in keys.items():
        if name not in known and name in parameters:
            followed[name] = value
        else:
            rest[name] = value
    if followed:
        return followed, rest
    return along, rest


def _listed_runs(some, key: str) -> list:
    runs = [some] if isinstance(some, Run) else list(some) if isinstance(some, (list, tuple)) else some
    if not isinstance(runs, list) or not all(isinstance(run, Run) for run in runs):
        raise StudyError(f"{key} is {some!r}", f"give a run, or a list of runs: {key}=run")
    return runs


def _start_of(start, at, onto) -> Optional[dict]:
    """What `start` says, with the run as an object."""
    if start is None:
        return None
    if isinstance(start, Point):
        start = start._start()
    elif isinstance(start, Run):
        start = {"run": start}
    elif not hasattr(start, "items"):
        raise StudyError(f"start is {start!r}", "give a run, a point of a branch, or {'run': run, 'at': {...}}")
    start = dict(start)
    if isinstance(start.get("run"), Point):
        start = {**start["run"]._start(), **{key: value for key, value in start.items() if key != "run"}}
    if not isinstance(start.get("run"), Run):
        raise StudyError(f"the run in start is {start.get('run')!r}", "give a run: start={'run': run, 'at': {...}}")
    for key, value in (("at", at), ("onto", onto)):
        if value is not None:
            start[key] = value
    if isinstance(start.get("point"), Point):
        start["point"] = start["point"]._name()
    return start


def _home(runs: list) -> "_Store":
    """The results to which one more run is added: those of the first of the runs that it needs, if there is room."""
    for run in runs:
        store = run._store
        if isinstance(store, _Store) and not store.busy and len(store.runs) < _MOST_RUNS:
            return store
    return _Store()


def _core_of(run: Run, store: _Results):
    """The model for which a run was asked, with none of the run's own settings where these are known."""
    text = store.runs.get(run.name)
    known = store.models.get(text.given.get("model")) if text is not None else None
    return known[1] if known else run._model


def _computed(kind: str, source, keys: dict, called: str, threads, progress, executor=None, folder=""):
    """Carries out a run that starts from a model (None: from none), a run or a point."""
    keys = dict(keys)
    if "from_" in keys:
        if "from" in keys:
            raise StudyError("from_ and from are the same", "give one of them")
        keys["from"] = keys.pop("from_")
    for name in ("kind", "model"):
        if name in keys:
            raise StudyError(f"{called} has no key '{name}'", "the function and its first argument say it")
    start, at, onto = (keys.pop(name, None) for name in ("start", "at", "onto"))
    if isinstance(source, (Run, Point)):
        start = source if start is None else start
        source = start if isinstance(start, Run) else None if isinstance(start, Point) else source
    elif source is not None and not isinstance(source, Model):
        raise TypeError(f"{called} needs a graze.Model, a run or a point, not {type(source).__name__}")
    start = _start_of(start, at, onto)
    if start is None and (at is not None or onto is not None):
        raise StudyError(f"{called} has '{'at' if at is not None else 'onto'}' without a start",
                         "give the run, or its point, as start=run")
    others = {key: _listed_runs(keys[key], key) for key in ("parameters", "records") if keys.get(key) is not None}
    needed = [start["run"]] if start else []
    needed += [run for some in others.values() for run in some]
    store = _home(needed)
    with store.lock:
        for key, runs in others.items():
            keys[key] = [store.take(run) for run in runs]
        asked = {}
        if isinstance(source, Model):
            asked["model"] = store.model_name(source._core)
        elif start is not None:
            asked["model"] = store.model_name(_core_of(start["run"], start["run"]._store))
        if start is not None:
            keys["start"] = {**start, "run": store.take(start["run"])}
        return store.compute(kind, {**asked, **keys}, called, threads, progress, executor, folder)


@takes_keys_of("simulate")
def ensemble(model: Source, *, threads: Optional[int] = None, executor: Any = None, progress: Progress = None,
             **keys: Any) -> Ensemble:
    """Simulates many motions of given length: `ensemble(model, vary={"omega": (2, 3, 101)}, periods=20)`.

    model: a Model; or a run or a point of a branch, with whose last, or `at={...}` nearest, state the motions begin.
    vary: for each parameter or initial state that varies a list of values, (from, to, points), or a dict as in studies.
    executor: a concurrent.futures.Executor whose workers compute, in place of threads; the results are the same.

    Returns an Ensemble. Raises StudyError for keys that cannot be used, and Interrupted, whose `run` has what was
    computed and can be resumed.
    """
    return _computed("simulate", model, keys, "ensemble()", threads, progress, executor)


@takes_keys_of("sweep")
def sweep(model: Source, *, threads: Optional[int] = None, executor: Any = None, progress: Progress = None,
          **keys: Any) -> Sweep:
    """What motions settle on as a parameter changes step by step: `sweep(model, vary={"omega": (2, 3, 101)})`.

    model, vary: see `ensemble`.
    executor: a concurrent.futures.Executor whose workers compute, in place of threads; the results are the same.

    Returns a Sweep. Raises StudyError and Interrupted as `ensemble`.
    """
    return _computed("sweep", model, keys, "sweep()", threads, progress, executor)


@takes_keys_of("basin")
def basin(model: Source, *, threads: Optional[int] = None, executor: Any = None, progress: Progress = None,
          **keys: Any) -> Basin:
    """What motions settle on from many initial states: `basin(model, vary={"x": (-1, 0, 50), "v": (-1, 1, 50)})`.

    model, vary: see `ensemble`.
    executor: a concurrent.futures.Executor whose workers compute, in place of threads; the results are the same.

    Returns a Basin. Raises StudyError and Interrupted as `ensemble`.
    """
    return _computed("basin", model, keys, "basin()", threads, progress, executor)


@takes_keys_of("orbit")
def orbit(model: Source, *, at: At = None, onto: Optional[str] = None, threads: Optional[int] = None,
          progress: Progress = None, **keys: Any) -> Orbit:
    """The periodic orbit on which the motion from the initial state settles, or that has a given signature.

    model: a Model; or a run, of which the orbit at `at={"omega": 2.5}` is taken, or a point of a branch.
    onto: see `Point.follow`.

    Returns an Orbit. Raises StudyError for keys that cannot be used, RunFailed if no orbit is found.
    """
    return _computed("orbit", model, {"at": at, "onto": onto, **keys}, "orbit()", threads, progress)


@takes_keys_of("continue")
def follow(model: Source, *, along: Along = None, at: At = None, onto: Optional[str] = None,
           threads: Optional[int] = None, progress: Progress = None, **keys: Any) -> "Branch":
    """A branch of periodic orbits along a parameter: `follow(model, omega=(2, 4))`, or along={"omega": (2, 4)}.

    model, at, onto: see `orbit`.

    Returns a Branch. Raises StudyError, RunFailed if no orbit is found, and Interrupted, whose `run` has the orbits found
    so far.
    """
    along, keys = _along("continue", along, keys, _any_core(model, "follow()"))
    return _computed("continue", model, {"along": along, "at": at, "onto": onto, **keys}, "follow()", threads, progress)


@takes_keys_of("curve")
def curve(point: Source, *, along: Along = None, onto: Optional[str] = None, threads: Optional[int] = None,
          progress: Progress = None, **keys: Any) -> "Curve":
    """The curve of special points in two parameters: `curve(branch["GR1"], omega=(2, 4), V=(0, 1))`.

    point: a Point, whose condition is held. onto: see `Point.curve`.

    Returns a Curve. Raises StudyError and RunFailed.
    """
    along, keys = _along("curve", along, keys, _any_core(point, "curve()"))
    return _computed("curve", point, {"along": along, "onto": onto, **keys}, "curve()", threads, progress)


@takes_keys_of("ladder")
def ladder(point: Source, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
           **keys: Any) -> "Ladder":
    """The sequence of grazings from a first one on, each with one contact more, up to the onset of chatter:
    `ladder(branch["GR1"], sigma=(0, 3))`.

    point: a Point of type GR, or of a curve of touches.

    Returns a Ladder. Raises StudyError and RunFailed.
    """
    along, keys = _along("ladder", along, keys, _any_core(point, "ladder()"))
    if along is None and isinstance(point, Point):
        along = point._along_as_before()
    return _computed("ladder", point, {"along": along, **keys}, "ladder()", threads, progress)


def _any_core(source, called: str):
    if isinstance(source, Model):
        return source._core
    if isinstance(source, Point):
        return source._run._model
    if isinstance(source, Run):
        return source._model
    raise TypeError(f"{called} needs a graze.Model, a run or a point, not {type(source).__name__}")


@takes_keys_of("record")
def record(model: Optional[Model] = None, *, folder: Path = "", threads: Optional[int] = None,
           progress: Progress = None, **keys: Any) -> Record:
    """Reads measured records, `record(files="release*.csv")`, or simulates a virtual bench that makes them,
    `record(model, bench={"channels": {"v": {"value": "v"}}, "rate": 1000, "time": 2})`.

    model: of the device on the virtual bench; files have none.
    folder: where files are looked for (the working folder).

    Returns a Record. Raises StudyError for keys and files that cannot be used.
    """
    if model is not None and not isinstance(model, Model):
        raise TypeError(f"record() needs a graze.Model or none, not {type(model).__name__}")
    return _computed("record", model, keys, "record()", threads, progress, folder=os.fspath(folder))


@takes_keys_of("identify")
def identify(model: Model, records: Runs, *, threads: Optional[int] = None, progress: Progress = None,
             **keys: Any) -> Identification:
    """Finds parameters of a model from records: `identify(model, records, what="fit", unknowns=["zeta"], readings=["q"])`.

    records: what `record` has returned, or a list of such.
    parameters: what other calls of `identify` have found, which is used with its errors.

    Returns an Identification. Raises StudyError for keys and records that cannot be used, and RunFailed for estimates
    that must not be used, as of a fit that has not converged; its `run` has the numbers all the same.
    """
    if not isinstance(model, Model):
        raise TypeError(f"identify() needs a graze.Model, not {type(model).__name__}")
    return _computed("identify", model, {"records": records, **keys}, "identify()", threads, progress)


class Study(Mapping):
    """The results of a study: a mapping from names of runs to runs. A file that is still being written shows what is
    there when it is asked.

    `reports` tells what `run_study` did for each run. Studies can be copied and pickled, with all results.
    """

    def __init__(self, path: Path, *, _store: Any = None) -> None:
        if _store is None:
            path = os.fspath(path)
            if os.path.isdir(path):
                path = os.path.join(path, "results.sqlite")
            _store = _StoredFile(path)
        self._store = _store
        self.path = _store.path
        self.reports: List[dict] = []

    @property
    def _study(self):
        with self._store._reading:
            return _graze.Study.stored(self._store.file)

    def __getitem__(self, name) -> Run:
        record = self._store.read("run", name) if isinstance(name, str) else None
        if record is None:
            raise KeyError(f"there is no run {name!r}; there are {', '.join(self)}")
        return RUNS.get(record["kind"], Run)(self._store, name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._store.read("names"))

    def __len__(self) -> int:
        return len(self._store.read("names"))

    @property
    def name(self) -> str:
        """The name of the study."""
        return self._study.name

    @property
    def text(self) -> str:
        """What the study is for, in words."""
        return self._study.text

    def query(self, sql: str) -> Table:
        """Rows of an SQL query, whose tables docs/result-file.md describes."""
        return Table(*self._store.read("query", sql, []))

    @property
    def format(self) -> int:
        """The format of the result file; docs/result-file.md tells what it means."""
        return self._store.file.format

    @property
    def missing(self) -> tuple:
        """What the file of an older format lacks of what this version writes."""
        return tuple(self._store.file.missing)

    @property
    def pictures(self) -> tuple:
        """Names of the pictures that the study describes."""
        return tuple(self._study.pictures)

    def plot(self, picture: str, *, axes: Any = None) -> Any:
        """Draws a picture of the study (`pictures` names them) with matplotlib. Returns the axes: one, or an array with
        one for each panel. axes: see `Run.plot`. Raises InputError if there is no such picture."""
        from ._plot import draw

        return draw(self._picture(picture), axes)

    def figure(self, picture: str) -> "Figure":
        """The data of a picture of the study."""
        from ._plot import Figure

        return Figure(self._picture(picture))

    def _picture(self, picture: str):
        study = self._study
        if picture not in study.pictures:
            known = ", ".join(study.pictures)
            raise InputError(f"the study has no picture {picture!r}", f"it has {known}" if known else "it has none", "plot()")
        with self._store._reading:
            return study.figure(self._store.file, picture)

    @property
    def tables(self) -> tuple:
        """Names of the tables that the study describes."""
        return tuple(self._study.tables)

    def table(self, name: str) -> Table:
        """A table of the study, by its name."""
        with self._store._reading:
            return Table(*self._study.table(self._store.file, name))

    def write_tables(self, folder: Path) -> List[str]:
        """Writes all tables of the study into a folder, as the program does: CSV with all digits. Existing files are
        replaced. Returns their paths."""
        study, paths = self._study, []
        with _writing(folder):
            os.makedirs(folder, exist_ok=True)
            for name in study.tables:
                with self._store._reading:
                    text = study.table_text(self._store.file, name)
                paths.append(os.path.join(os.fspath(folder), f"{name}.csv"))
                with open(paths[-1], "w", encoding="utf-8", newline="") as file:
                    file.write(text)
        return paths

    def write_pictures(self, folder: Path, *, format: str = "png") -> List[str]:
        """Draws all pictures of the study with matplotlib into a folder. Existing files are replaced. Returns their
        paths."""
        import numpy
        from matplotlib import pyplot

        paths = []
        with _writing(folder):
            os.makedirs(folder, exist_ok=True)
            for name in self.pictures:
                with pyplot.ioff():
                    figure = numpy.atleast_1d(self.plot(name)).ravel()[0].figure
                paths.append(os.path.join(os.fspath(folder), f"{name}.{format}"))
                figure.savefig(paths[-1])
                pyplot.close(figure)
        return paths

    def __reduce__(self):
        return _restored_study, (self._store, self.reports)

    def __eq__(self, other):
        return self is other

    __hash__ = object.__hash__

    def __repr__(self):
        records = self._store.read("runs")
        runs = ", ".join(f"{record['name']} ({record['kind']}, {record['status']})" for record in records)
        return f"<Study {self.path}: {runs}>"


def _restored_study(store: _Store, reports: list) -> Study:
    study = Study(None, _store=store)
    study.reports = reports
    return study


def read_results(path: Path) -> Study:
    """Reads a result file, or that in the folder of a study, also while another program writes it. Raises FileError if
    there is none, and InputError for another file."""
    return Study(path)


def run_study(study: Path, *, output: Optional[Path] = None, only: Union[str, Iterable[str]] = (),
              set: Optional[Mapping[str, float]] = None, models: Optional[Mapping[str, Model]] = None,
              threads: Optional[int] = None, executor: Any = None, progress: Progress = None) -> Study:
    """Carries out a study and returns its results.

    study: the name of a shipped one, the path of a file, or the text of a study (with several lines), whose files are
        looked for in the working folder.
    output: a folder where results are kept, as they come; what is there already is not computed again. None: they are
        kept as long as the object that is returned.
    only: names of the runs to be carried out, with those that they need. set: values of parameters, a dict.
    models: models that a text may name, besides shipped ones and files: a dict of name and Model.
    executor: a concurrent.futures.Executor whose workers compute the points of sweeps, basins and ensembles.

    A run that fails does not stop the others: `reports` of the results tells. Raises StudyError for a study that cannot
    be read, and Interrupted, whose `run` has the results so far: the same call goes on from there, to the same bits.
    """
    _threads(threads)
    read = _read_study(study, set, models)
    if output is None:
        store = _Store()
        path, file = store.path, store.writer
    else:
        store = None
        with _writing(output):
            os.makedirs(output, exist_ok=True)
        path = os.path.join(os.fspath(output), "results.sqlite")
        file = _graze.ResultFile(path, write=True)
        read.require_same_values(file)

    def results():
        return Study(path, _store=store)

    try:
        reports = _carried_out(read, file, only=[only] if isinstance(only, str) else list(only), threads=threads,
                               progress=progress, executor=executor)
    except KeyboardInterrupt:
        raise Interrupted(results()) from None
    except WorkersLost as error:
        error.run = results()
        raise
    result = results()
    result.reports = reports
    if any(report["status"] == "interrupted" for report in reports):
        raise Interrupted(result)
    return result


def _read_study(study, set, models):
    values = []
    for name, value in (set or {}).items():
        if isinstance(value, bool) or not hasattr(value, "__float__"):
            raise StudyError(f"the value of {name} in set is {value!r}", "give a number")
        values.append((str(name), float(value)))
    try:
        if isinstance(study, str) and "\n" in study:
            cores = {name: model._core for name, model in (models or {}).items()}
            return _graze.Study.parsed(study, "study", values, cores)
        if models:
            raise StudyError("models are given for a study that is no text", "give the text of the study")
        return _graze.Study.loaded(os.fspath(study), values)
    except InputError as error:
        raise as_kind(error, StudyError) from None


def studies() -> tuple:
    """Names of the studies that come with graze."""
    return tuple(_graze.shipped_studies())
