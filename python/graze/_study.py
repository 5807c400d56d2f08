"""Studies and their results."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Dict, Iterable, Iterator, List, Optional, Sequence, Tuple, Union

from . import _arguments as checked, _graze
from ._analysis import called
from ._attributes import Fixed
from ._computing import Ways, carried_out
from ._errors import InputError, Interrupted, StudyError, WorkersLost, as_kind
from ._expressions import is_plain
from ._model import Model
from ._output import Path, Replacement, made_folder, write_file
from ._progress import Progress, interruptible
from ._results import Results, Store, StoredFile
from ._run import Run
from ._table import Table

if TYPE_CHECKING:
    from ._plot import Figure


class Study(Fixed, Mapping):  # type: ignore[type-arg]
    """The results of a study: a mapping from names of runs to runs. A file that is still being written shows what is
    there when it is asked.

    `reports` tells what `run_study` did for each run. Studies can be copied and pickled, with all results.
    """

    path: str
    reports: List[Dict[str, Any]]

    def __init__(self, path: Path, *, _store: Any = None) -> None:
        if _store is None:
            file = checked.path_of(path, "results")
            _store = StoredFile(os.path.join(file, "results.sqlite") if os.path.isdir(file) else file)
        self._store = _store
        self.path = _store.path
        self.reports = []

    @property
    def _study(self) -> Any:
        with self._store.reading() as file:
            return _graze.Study.stored(file)

    def __getitem__(self, name: str) -> Run:
        record = self._store.read("run", name) if isinstance(name, str) and is_plain(name) else None
        if record is None:
            raise KeyError(f"there is no run {name!r}; there are {', '.join(self)}")
        return Run._kinds.get(record["kind"], Run)(self._store, name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._store.read("names"))

    def __len__(self) -> int:
        return len(self._store.read("names"))

    @property
    def name(self) -> str:
        """The name of the study."""
        return str(self._study.name)

    @property
    def text(self) -> str:
        """What the study is for, in words."""
        return str(self._study.text)

    def query(self, sql: str) -> Table:
        """Rows of an SQL query, whose tables docs/result-file.md describes."""
        return Table(*self._store.read("query", checked.text(sql, "sql"), []))

    @property
    def format(self) -> int:
        """The format of the result file; docs/result-file.md tells what it means."""
        return int(self._store.file.format)

    @property
    def missing(self) -> Tuple[str, ...]:
        """What the file of an older format lacks of what this version writes."""
        return tuple(self._store.file.missing)

    @property
    def pictures(self) -> Tuple[str, ...]:
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

    def _picture(self, picture: str) -> Any:
        study = self._study
        if checked.text(picture, "picture") not in study.pictures:
            known = ", ".join(study.pictures)
            raise InputError(f"the study has no picture {picture!r}", f"it has {known}" if known else "it has none", "plot()")
        return self._drawn(study, picture)

    def _drawn(self, study: Any, picture: str) -> Any:
        with self._store.reading() as file:
            return study.figure(file, picture)

    @property
    def tables(self) -> Tuple[str, ...]:
        """Names of the tables that the study describes."""
        return tuple(self._study.tables)

    def table(self, name: str) -> Table:
        """A table of the study, by its name."""
        with self._store.reading() as file:
            return Table(*self._study.table(file, checked.text(name, "name")))

    def write_tables(self, folder: Path) -> List[str]:
        """Writes all tables of the study into a folder, as the program does: CSV with all digits. Existing files are
        replaced. Returns their paths."""
        study, place = self._study, made_folder(folder)
        paths = [os.path.join(place, f"{name}.csv") for name in study.tables]
        for name, path in zip(study.tables, paths):
            with self._store.reading() as file:
                text = study.table_text(file, name)
            write_file(path, text)
        return paths

    def write_pictures(self, folder: Path, *, format: str = "png") -> List[str]:
        """Draws all pictures of the study with matplotlib into a folder. Existing files are replaced. Returns their
        paths."""
        import numpy
        from matplotlib import pyplot

        from ._plot import draw

        ending = checked.text(format, "format")
        study, place = self._study, made_folder(folder)
        paths = [os.path.join(place, f"{name}.{ending}") for name in study.pictures]
        for name, path in zip(study.pictures, paths):
            with pyplot.ioff():
                figure = numpy.atleast_1d(draw(self._drawn(study, name))).ravel()[0].figure
            try:
                with Replacement(path) as temporary:
                    figure.savefig(temporary)
            finally:
                pyplot.close(figure)
        return paths

    def __reduce__(self) -> Tuple[Any, ...]:
        return _restored_study, (self._store, self.reports)

    def __eq__(self, other: object) -> bool:
        return self is other

    __hash__ = object.__hash__

    def __repr__(self) -> str:
        records = self._store.read("runs")
        runs = ", ".join(f"{record['name']} ({record['kind']}, {record['status']})" for record in records)
        return f"<Study {self.path}: {runs}>"


def _restored_study(store: Results, reports: List[Dict[str, Any]]) -> Study:
    study = Study(store.path, _store=store)
    study.reports = reports
    return study


def read_results(path: Path) -> Study:
    """Reads a result file, or that in the folder of a study, also while another program writes it. Raises FileError if
    there is none, and InputError for another file."""
    return Study(path)


@interruptible()
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
    ways = Ways(threads, progress, executor)
    chosen = checked.names(only, "only")
    read = _read_study(study, set, models)
    store: Optional[Store] = None
    if output is None:
        store = Store()
        path, file = store.path, store.writer
    else:
        path = os.path.join(made_folder(output), "results.sqlite")
        file = _graze.ResultFile(path, write=True)
        read.require_same_values(file)

    def results() -> Study:
        return Study(path, _store=store)

    try:
        reports = carried_out(read, file, chosen, ways)
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


def _read_study(study: Any, values: Optional[Mapping[str, float]], models: Optional[Mapping[str, Model]]) -> Any:
    try:
        given = checked.settings({} if values is None else values)
        named = {} if models is None else checked.a_dict(models, "models", '{"name": model}')
        for name, model in named.items():
            if not isinstance(model, Model):
                raise checked.wrong(model, f"models, {name}", "is no model", "give a graze.Model")
        if isinstance(study, str) and "\n" in study:
            cores = {checked.text(name, "models"): model._core for name, model in named.items()}
            return _graze.Study.parsed(checked.text(study, "study"), "study", given, cores)
        if named:
            raise StudyError("models are given for a study that is no text", "give the text of the study")
        return _graze.Study.loaded(checked.path_of(study, "a study"), given)
    except InputError as error:
        raise as_kind(error, StudyError) from None


def studies() -> Tuple[str, ...]:
    """Names of the studies that come with graze."""
    return tuple(_graze.shipped_studies())


def points(results: Any, *, run: Union[str, Sequence[str]] = (), type: Union[str, Sequence[str]] = (),
           all: bool = False) -> Table:
    """The special points of branches, with all columns of `graze points --format csv`.

    results: a run, or all results that were read (`read_results`, `run_study`).
    run: names of runs, of several (all branches). type: types, as "GR" or ("GR", "SN") (all special ones).
    all: regular points too.

    Raises InputError where there are no branches, and for types that do not exist.
    """
    if not isinstance(results, (Run, Study)):
        raise TypeError(f"points() needs a run or the results of a study, not {results.__class__.__name__}")
    with called("points()"), results._store.reading() as file:
        runs, types = checked.names(run, "run"), checked.names(type, "type")
        if not runs and isinstance(results, Run):
            runs = [results.name]
        return Table(*_graze.listed_points(file, runs=runs, types=[one.upper() for one in types],
                                           all=checked.truth(all, "all")))
