"""How a call asks for a run: what it starts from, what it needs, and to which results it is added."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple, Type, TypeVar, Union

from . import _graze
from ._analyses import PointAnalyses
from ._arguments import near
from ._computing import Ways
from ._errors import StudyError
from ._expressions import is_plain
from ._keywords import keys_of
from ._model import Model
from ._results import Store
from ._run import Run

if TYPE_CHECKING:
    from ._point import Point

Source = Union[Model, Run, "Point"]
"""Where a run starts: from the initial state of a model, from another run, or from a point of a branch."""
Along = Union[None, str, Mapping[str, Any]]
"""What is followed: parameters with their bounds, {"omega": (2, 4)}."""

OneRun = TypeVar("OneRun", bound=Run)

MOST_RUNS = 16  # in one file: what is written to it costs more, the more runs it has


def compiled_model(source: Any, called: str) -> Any:
    """The compiled part of the model of what a run starts from, not to be changed."""
    if isinstance(source, Model):
        return source._core
    if isinstance(source, PointAnalyses):
        return source._run._model
    if isinstance(source, Run):
        return source._model
    raise TypeError(f"{called} needs a graze.Model, a run or a point, not {type(source).__name__}")


def separated(kind: str, along: Along, keys: Dict[str, Any], model: Any, called: str) -> Tuple[Along, Dict[str, Any]]:
    """Separates parameters that are followed, given as keyword arguments, from the keys of a run."""
    known, parameters = keys_of(kind), [one["name"] for one in model.parameters] + [name for name, *_ in model.conserved]
    followed: Dict[str, Any] = dict(along) if isinstance(along, Mapping) else {}
    rest: Dict[str, Any] = {}
    for name, value in keys.items():
        if name not in known and name in parameters:
            followed[name] = value
        else:
            rest[name] = value
    require_known(kind, rest, called, parameters)
    return followed or along, rest


def require_known(kind: str, keys: Dict[str, Any], called: str, others: Sequence[str] = ()) -> None:
    """Refuses keys that no run has, and those that runs of this kind do not have also where they are None, which says
    that a key is not given. others: names that the call may have besides."""
    known = keys_of(kind)
    anywhere = {name for one in _graze.kinds_of_runs() for name in keys_of(one)}
    for name, value in keys.items():
        if name not in known and (value is None or name not in anywhere):
            place = called if not is_plain(name) else f"{called}, {name}"
            raise StudyError(f"unknown key {name!r} in {called}", near(name, [*others, *known]), place)


def _listed_runs(some: Any, key: str) -> List[Run]:
    runs = [some] if isinstance(some, Run) else list(some) if isinstance(some, (list, tuple)) else some
    if not isinstance(runs, list) or not all(isinstance(run, Run) for run in runs):
        raise StudyError(f"{key} is {some!r}", f"give a run, or a list of runs: {key}=run")
    return runs


def _start_of(start: Any, at: Any, onto: Any) -> Optional[Dict[str, Any]]:
    """What `start` says, with the run as an object."""
    if start is None:
        return None
    if isinstance(start, PointAnalyses):
        start = start._start()
    elif isinstance(start, Run):
        start = {"run": start}
    elif not hasattr(start, "items"):
        raise StudyError(f"start is {start!r}", "give a run, a point of a branch, or {'run': run, 'at': {...}}")
    start = dict(start)
    if isinstance(start.get("run"), PointAnalyses):
        start = {**start["run"]._start(), **{key: value for key, value in start.items() if key != "run"}}
    if not isinstance(start.get("run"), Run):
        raise StudyError(f"the run in start is {start.get('run')!r}", "give a run: start={'run': run, 'at': {...}}")
    for key, value in (("at", at), ("onto", onto)):
        if value is not None:
            start[key] = value
    if isinstance(start.get("point"), PointAnalyses):
        start["point"] = start["point"]._name()
    return dict(start)


def _home(runs: List[Run]) -> Store:
    """The results to which one more run is added: those of the first of the runs that it needs, if there is room."""
    for run in runs:
        store = run._store
        if isinstance(store, Store) and not store.busy and len(store.runs) < MOST_RUNS:
            return store
    return Store()


def _model_asked_for(run: Run) -> Any:
    """The model for which a run was asked, with none of the run's own settings where these are known."""
    text = run._store.runs.get(run.name)
    known = run._store.models.get(text.given.get("model", "")) if text is not None else None
    return known[1] if known else run._model


def computed(of: Type[OneRun], source: Any, keys: Dict[str, Any], called: str, ways: Ways, folder: Any = "") -> OneRun:
    """Carries out a run of a class that starts from a model (None: from none), a run or a point. folder: of files that it
    reads."""
    keys = dict(keys)
    if "from_" in keys:
        if "from" in keys:
            raise StudyError("from_ and from are the same", "give one of them")
        keys["from"] = keys.pop("from_")
    for name in ("kind", "model"):
        if name in keys:
            raise StudyError(f"{called} has no key '{name}'", "the function and its first argument say it")
    given, at, onto = (keys.pop(name, None) for name in ("start", "at", "onto"))
    require_known(of.kind, keys, called)
    if isinstance(source, (Run, PointAnalyses)):
        given = source if given is None else given
        source = None
    elif source is not None and not isinstance(source, Model):
        raise TypeError(f"{called} needs a graze.Model, a run or a point, not {type(source).__name__}")
    start = _start_of(given, at, onto)
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
        if source is not None:
            asked["model"] = store.model_name(source._core)
        elif start is not None:
            asked["model"] = store.model_name(_model_asked_for(start["run"]))
        if start is not None:
            keys["start"] = {**start, "run": store.take(start["run"])}
        return store.compute(of, {**asked, **keys}, called, ways, folder)
