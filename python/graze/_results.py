"""Results in files: those that were written before, and those of runs that functions ask for."""

from __future__ import annotations

import functools
import itertools
import os
import threading
import weakref
import zlib
from contextlib import contextmanager
from typing import Any, Dict, Iterable, Iterator, List, Optional, Set, Tuple

from . import _graze
from ._computing import Ways, carried_out
from ._errors import Error, FileError, InputError, Interrupted, OrderError, RunFailed, WorkersLost
from ._keywords import CallText, RunText
from ._output import OwnFolder, writing


@functools.lru_cache(maxsize=None)
def _empty_file() -> bytes:
    """A result file without runs. To copy it is quicker than to make one, for which SQLite waits for the disk."""
    folder = OwnFolder()
    path = os.path.join(folder.path, "empty.sqlite")
    _graze.ResultFile(path, write=True)
    with open(path, "rb") as file:
        return file.read()


def _write_temporary(path: str, contents: bytes) -> None:
    """Writes a result file that is to be written further. Bytes 18 and 19 say that SQLite keeps a write-ahead log, as it does
    for all result files that are written, so that it need not change them and wait for the disk."""
    with writing(path), open(path, "wb") as file:
        file.write(contents[:18] + b"\2\2" + contents[20:])


# Results that are open in this process, for those that are forked from it.
_ALL: weakref.WeakSet[Results] = weakref.WeakSet()


def _after_fork() -> None:
    for one in list(_ALL):
        one._forked()


os.register_at_fork(after_in_child=_after_fork)


class Results:
    """The results in a file. It is read by a connection of its own, so that it can be read while it is written."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.runs: Dict[str, RunText] = {}  # that were asked for by calls, by their names
        self.models: Dict[str, Tuple[str, Any]] = {}  # name in these texts -> text and compiled part of the model
        self._handle: Any = None
        self._reading = threading.RLock()
        self._parsed: Dict[str, Any] = {}  # text -> compiled part, of models of runs
        _ALL.add(self)

    @property
    def file(self) -> Any:
        """The file, for reading."""
        with self._reading:
            if self._handle is None:
                self._handle = _graze.ResultFile(self.path, write=False)
            return self._handle

    @contextmanager
    def reading(self) -> Iterator[Any]:
        """The file, while it is read; one thread at a time does."""
        with self._reading:
            try:
                yield self.file
            except UnicodeDecodeError:
                raise FileError(f"{self.path}: the file is damaged: it has texts that are not in UTF-8",
                                "make it again, or take a copy") from None

    def read(self, what: str, *arguments: Any, **keys: Any) -> Any:
        """Calls a function that reads the file."""
        with self.reading() as file:
            return getattr(file, what)(*arguments, **keys)

    def model_of(self, text: str) -> Any:
        """The compiled part of the model of a run, not to be changed. Each text is read once."""
        with self._reading:
            if text not in self._parsed:
                self._parsed[text] = _graze.Model.parsed(text, "model")
            return self._parsed[text]

    def copy(self, path: str, names: Iterable[str] = ()) -> None:
        """Writes a result file with these runs and those that they need, or with all."""
        if os.path.lexists(path):
            raise FileError(f"the file {path} is there already", "choose another name, or remove it first")
        self._copy_into(path, names)

    def _copy_into(self, path: str, names: Iterable[str] = ()) -> None:
        file = _graze.ResultFile(path, write=True)
        chosen = list(names)
        with self.reading() as own:
            file.take_runs(own, chosen)
            _graze.Study.stored(file if chosen else own).store(file)

    def contents(self) -> bytes:
        folder = OwnFolder()
        path = os.path.join(folder.path, "copy.sqlite")
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

    def resume(self, made: Any, ways: Ways) -> Any:
        raise InputError(f"run '{made.name}' belongs to the file {self.path}, which is only read",
                         "carry out its study again with the same output: what is there is not computed again")

    def __reduce__(self) -> Tuple[Any, ...]:
        models = {name: text for name, (text, _) in self.models.items()}
        return _restored_store, (zlib.compress(self.contents(), 1), self.runs, models)

    def __deepcopy__(self, memo: Any) -> Any:
        restored, arguments = self.__reduce__()
        return restored(*arguments)


def _restored_store(contents: bytes, runs: Dict[str, RunText], models: Dict[str, str]) -> Store:
    store = Store(zlib.decompress(contents))
    store.runs.update(runs)
    store.models.update((name, (text, _graze.Model.parsed(text, "model"))) for name, text in models.items())
    return store


class StoredFile(Results):
    """A result file that was written before, or is being written by another program."""

    def __init__(self, path: str, keeps: Any = None) -> None:
        """keeps: what has to live as long as these results, as the temporary folder of the file."""
        super().__init__(path)
        self._keeps = keeps
        self.file  # opened now, so that a missing file is told now


class Store(Results):
    """A result file of calls: runs that follow from one another. It lives as long as a run in it."""

    writer: Any = None  # the file, for writing; None in a process that was forked since it was opened

    def __init__(self, contents: Optional[bytes] = None) -> None:
        self.folder = OwnFolder()
        super().__init__(os.path.join(self.folder.path, "results.sqlite"))
        _write_temporary(self.path, _empty_file() if contents is None else contents)
        self._open()

    def _open(self) -> None:
        self.lock = threading.RLock()
        self.busy = False
        self.writer = _graze.ResultFile(self.path, write=True)
        self._study: Any = None  # of all runs of the file, once it is needed
        # Results -> names of runs there -> names here.
        self._taken: weakref.WeakKeyDictionary[Results, Dict[str, str]] = weakref.WeakKeyDictionary()

    def _forked(self) -> None:
        super()._forked()
        if self.writer is not None:
            _graze.never_destroy(self.writer)
        self.writer = None
        self.lock = threading.RLock()

    def _own(self) -> None:
        """Makes the file one that this process may write, if it was forked since."""
        if self.writer is None:
            folder = OwnFolder()
            path = os.path.join(folder.path, "results.sqlite")
            _write_temporary(path, _empty_file())
            self._copy_into(path)
            self.folder, self.path, self._handle = folder, path, None
            self._open()

    def model_name(self, core: Any) -> str:
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

    def take(self, run: Any) -> str:
        """The name that a run of any results has here, to where it is copied with what it needs."""
        if run._store is self:
            return str(run.name)
        with self.lock:
            known = self._taken.setdefault(run._store, {})
            if run.name not in known:
                self._own()
                with run._store.reading() as file:
                    names = self.writer.take_runs(file, [run.name])
                self._study = None
                known.update(names)
                for name, text in run._store.runs.items():
                    if name in names and names[name] not in self.runs:
                        model = run._store.models.get(text.given.get("model"))
                        self.runs[names[name]] = text.renamed(names[name], names, model and self.model_name(model[1]))
            return known[run.name]

    def needed(self, names: List[str]) -> List[str]:
        """Runs and those that they need, in the order of computing."""
        wanted: Set[str] = set()

        def want(name: str) -> None:
            if name not in wanted:
                wanted.add(name)
                for need in self.runs[name].needs() if name in self.runs else ():
                    want(need)

        for name in names:
            want(name)
        return [name for name in dict.fromkeys([*self.runs, *names, *sorted(wanted)]) if name in wanted]

    def compute(self, of: Any, keys: Dict[str, Any], called: str, ways: Ways, folder: Any = "") -> Any:
        """Carries out one more run, of a class of runs. Returns it."""
        with self.lock:
            self._require_idle()
            self._own()
            name = self.free_name(of.kind)
            run = RunText(name, of.kind, keys, folder)
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
            return self._carry_out(text, of(self, name), ways)

    def resume(self, made: Any, ways: Ways) -> Any:
        with self.lock:
            self._require_idle()
            self._own()
            if self._study is None:
                self._study = _graze.Study.stored(self.writer)
            text = CallText(self.runs.get(made.name, RunText(made.name, made.kind, {})), "resume()")
            return self._carry_out(text, made, ways)

    def _require_idle(self) -> None:
        if self.busy:
            raise OrderError("another run is being computed, and this one would be kept in the same file",
                             "begin it when that one has ended, not in the function that is told of its progress")

    def _carry_out(self, text: CallText, made: Any, ways: Ways) -> Any:
        self.busy = True
        try:
            reports = carried_out(self._study, self.writer, [made.name], ways)
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
