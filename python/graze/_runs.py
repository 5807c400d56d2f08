"""The functions that carry out runs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Optional

from . import _arguments as checked
from ._branch import Branch, Curve, Equilibria, Ladder, Orbit, Tori
from ._calls import Along, Source, compiled_model, computed, separated
from ._computing import Ways
from ._identification import Identification, Record
from ._keywords import takes_keys_of
from ._model import Model
from ._output import OwnFolder, Path
from ._point import Point
from ._progress import Progress
from ._run import Basin, Ensemble, Runs, Sweep

At = Optional[Mapping[str, float]]
"""The value that chooses the nearest point of a run, {"omega": 2.5}."""


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
    return computed(Ensemble, model, keys, "ensemble()", Ways(threads, progress, executor))


@takes_keys_of("sweep")
def sweep(model: Source, *, threads: Optional[int] = None, executor: Any = None, progress: Progress = None,
          **keys: Any) -> Sweep:
    """What motions settle on as a parameter changes step by step: `sweep(model, vary={"omega": (2, 3, 101)})`.

    model, vary: see `ensemble`. A list of values is taken in rising order, as in studies; `direction` turns it round.
    executor: a concurrent.futures.Executor whose workers compute, in place of threads; the results are the same.

    Returns a Sweep. Raises StudyError and Interrupted as `ensemble`.
    """
    return computed(Sweep, model, keys, "sweep()", Ways(threads, progress, executor))


@takes_keys_of("basin")
def basin(model: Source, *, threads: Optional[int] = None, executor: Any = None, progress: Progress = None,
          **keys: Any) -> Basin:
    """What motions settle on from many initial states: `basin(model, vary={"x": (-1, 0, 50), "v": (-1, 1, 50)})`.

    model, vary: see `ensemble`.
    executor: a concurrent.futures.Executor whose workers compute, in place of threads; the results are the same.

    Returns a Basin. Raises StudyError and Interrupted as `ensemble`.
    """
    return computed(Basin, model, keys, "basin()", Ways(threads, progress, executor))


@takes_keys_of("orbit")
def orbit(model: Source, *, at: At = None, onto: Optional[str] = None, threads: Optional[int] = None,
          progress: Progress = None, **keys: Any) -> Orbit:
    """The periodic orbit on which the motion from the initial state settles, or that has a given signature.

    model: a Model; or a run, of which the orbit at `at={"omega": 2.5}` is taken, or a point of a branch.
    onto: see `Point.follow`.

    Returns an Orbit. Raises StudyError for keys that cannot be used, RunFailed if no orbit is found.
    """
    return computed(Orbit, model, {"at": at, "onto": onto, **keys}, "orbit()", Ways(threads, progress))


@takes_keys_of("equilibrium")
def equilibria(model: Source, *, at: At = None, threads: Optional[int] = None, progress: Progress = None,
               **keys: Any) -> Equilibria:
    """All equilibria in a box of states, `equilibria(model, within={"x": (-1, 1), "v": (-1, 1)})`, proven to be all; or,
    without a box, the one to which Newton's method leads from the initial state.

    model: a Model; or a run or a point, near whose last state an equilibrium is looked for. at: see `orbit`.

    Returns Equilibria. Raises StudyError for keys that cannot be used, RunFailed if there is none.
    """
    return computed(Equilibria, model, {"at": at, **keys}, "equilibria()", Ways(threads, progress))


@takes_keys_of("continue")
def follow(model: Source, *, along: Along = None, at: At = None, onto: Optional[str] = None,
           threads: Optional[int] = None, progress: Progress = None, **keys: Any) -> Branch:
    """A branch of periodic orbits, or of equilibria, along a parameter: `follow(model, omega=(2, 4))`, or
    along={"omega": (2, 4)}.

    model, at, onto: see `orbit`.

    Returns a Branch. Raises StudyError, RunFailed if no orbit is found, and Interrupted, whose `run` has the orbits found
    so far.
    """
    along, keys = separated("continue", along, keys, compiled_model(model, "follow()"), "follow()")
    return computed(Branch, model, {"along": along, "at": at, "onto": onto, **keys}, "follow()", Ways(threads, progress))


@takes_keys_of("curve")
def curve(point: Source, *, along: Along = None, onto: Optional[str] = None, threads: Optional[int] = None,
          progress: Progress = None, **keys: Any) -> Curve:
    """The curve of special points in two parameters: `curve(branch["GR1"], omega=(2, 4), V=(0, 1))`.

    point: a Point, whose condition is held. onto: see `Point.curve`.

    Returns a Curve. Raises StudyError and RunFailed.
    """
    along, keys = separated("curve", along, keys, compiled_model(point, "curve()"), "curve()")
    return computed(Curve, point, {"along": along, "onto": onto, **keys}, "curve()", Ways(threads, progress))


@takes_keys_of("ladder")
def ladder(point: Source, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
           **keys: Any) -> Ladder:
    """The sequence of grazings from a first one on, each with one contact more, up to the onset of chatter:
    `ladder(branch["GR1"], sigma=(0, 3))`.

    point: a Point of type GR, or of a curve of touches.

    Returns a Ladder. Raises StudyError and RunFailed.
    """
    along, keys = separated("ladder", along, keys, compiled_model(point, "ladder()"), "ladder()")
    if along is None and isinstance(point, Point):
        along = point._along_as_before()
    return computed(Ladder, point, {"along": along, **keys}, "ladder()", Ways(threads, progress))


@takes_keys_of("torus")
def torus(point: Source, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
          **keys: Any) -> Tori:
    """The tori of quasi-periodic motion that begin at a torus point, as a parameter changes:
    `torus(branch["NS1"], V=(0, 1))`.

    point: a Point of type NS.

    Returns Tori. Raises StudyError, and RunFailed where none begin.
    """
    along, keys = separated("torus", along, keys, compiled_model(point, "torus()"), "torus()")
    if along is None and isinstance(point, Point):
        along = point._along_as_before()
    return computed(Tori, point, {"along": along, **keys}, "torus()", Ways(threads, progress))


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
    return computed(Record, model, keys, "record()", Ways(threads, progress),
                    folder if isinstance(folder, OwnFolder) or folder == "" else checked.path_of(folder, "a folder", "folder"))


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
    return computed(Identification, model, {"records": records, **keys}, "identify()", Ways(threads, progress))
