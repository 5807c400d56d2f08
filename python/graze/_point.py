"""Orbits of runs, and the runs that go on from them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple

from ._analyses import PointAnalyses
from ._attributes import Fixed
from ._calls import Along, computed, separated
from ._computing import Ways
from ._errors import InputError
from ._keywords import takes_keys_of
from ._model import Model
from ._progress import Progress, interruptible

if TYPE_CHECKING:
    from ._branch import Branch, Curve, Ladder, Orbit, Tori

# Keys that have no effect where a run starts from an orbit.
_OF_SETTLING = ("start", "from", "mode", "signature", "table", "section", "bounds", "cycles", "largest_period", "recurrence",
                "disturbance", "longest_return", "order", "largest_step")

NOTHING_FOLLOWED = "an orbit by itself follows no parameter; its dict `parameters` has the values of all"


class Point(Fixed, PointAnalyses):
    """An orbit of a run: a special point of a branch, or a regular one.

    Attributes: `label` ("GR1"; empty for regular points), `number`, `type` ("GR"), `type_words` ("grazing"), `detail`,
    `parameter` (value of the one that is followed), `period`, `stable`, `multipliers` (complex, the largest first; empty
    where they are not defined, and of models with more than 256 states only those outside a circle: the `other_multipliers`,
    0 for other models, lie within the radius `others_within`), `half_multipliers` of symmetric orbits, `eigenvalues` of equilibria (complex, per unit of
    time, the largest real part first; their period is 0), `unphysical`, `error` (estimated, relative),
    `starts` (segments x states), `durations` and `approach_speeds` (segments); and dicts `parameters`, `monitors`. Arrays can be read only: copy them to change them.
    """

    parameters: Dict[str, float]
    monitors: Dict[str, float]

    def __init__(self, run: Branch, made: Dict[str, Any], parameters: Sequence[str], monitors: Sequence[str]) -> None:
        self._run = run
        self._made = made
        self.parameters = dict(zip(parameters, made.pop("parameters").tolist()))
        self.monitors = dict(zip(monitors, made.pop("monitors").tolist()))
        for value in made.values():
            if hasattr(value, "setflags"):
                value.setflags(write=False)  # the point is kept: nobody is to change it for all

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name == "parameter" and not self._run._followed:
            raise AttributeError(NOTHING_FOLLOWED)
        try:
            return self._made[name]
        except KeyError:
            raise AttributeError(f"an orbit has no attribute {name!r}; it has {', '.join(self._made)}") from None

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self._made]

    @property
    def run(self) -> Branch:
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

    def _child(self, kind: str, keys: Dict[str, Any], called: str, ways: Ways, onto: Optional[str] = None) -> Any:
        return computed(self._run._kinds[kind], self._run, {"start": {**self._start(), "onto": onto}, **keys}, called, ways)

    @takes_keys_of("continue", *_OF_SETTLING)
    def follow(self, *, along: Along = None, onto: Optional[str] = None, threads: Optional[int] = None,
               progress: Progress = None, **keys: Any) -> Branch:
        """The branch through this point along a parameter: `follow(omega=(2, 4))`, or along={"omega": (2, 4)}.

        onto: "same", "other" or "twin" (chosen by the type of the point), or "homoclinic": orbits that leave this one, a
        saddle, and come back. Raises RunFailed where no orbit is found.
        """
        along, keys = separated("continue", along, keys, self._run._model, "follow()")
        return self._child("continue", {"along": along, **keys}, "follow()", Ways(threads, progress), onto)

    @takes_keys_of("continue", *_OF_SETTLING)
    def switch(self, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
               **keys: Any) -> Branch:
        """The other branch that leaves here, along the same parameter unless `along` says another: beyond a grazing the
        orbits with one contact more, at a flip those of twice the period, at a branch point the other branch, where a
        symmetry is lost the orbits without it, at a Hopf point of an equilibrium the cycles that begin."""
        along, keys = separated("continue", along, keys, self._run._model, "switch()")
        along = self._along_as_before() if along is None else along
        return self._child("continue", {"along": along, **keys}, "switch()", Ways(threads, progress), "other")

    @takes_keys_of("continue", *_OF_SETTLING)
    def double(self, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
               **keys: Any) -> Branch:
        """The orbits of twice the period that leave at a flip. InputError for other points."""
        if self.type != "PD":
            raise InputError(f"{self._name()} is no flip (PD) but {self.type_words}", "use switch()")
        along, keys = separated("continue", along, keys, self._run._model, "double()")
        along = self._along_as_before() if along is None else along
        return self._child("continue", {"along": along, **keys}, "double()", Ways(threads, progress), "other")

    @takes_keys_of("continue", *_OF_SETTLING)
    def twin(self, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
             **keys: Any) -> Branch:
        """The branch through the symmetric image of this orbit, under the symmetry that the model declares."""
        along, keys = separated("continue", along, keys, self._run._model, "twin()")
        along = self._along_as_before() if along is None else along
        return self._child("continue", {"along": along, **keys}, "twin()", Ways(threads, progress), "twin")

    @interruptible()
    def image(self, *, threads: Optional[int] = None, progress: Progress = None) -> Orbit:
        """The symmetric image of this orbit, under the symmetry that the model declares."""
        return self._child("orbit", {}, "image()", Ways(threads, progress), "twin")

    @takes_keys_of("curve", *_OF_SETTLING)
    def curve(self, *names: str, along: Along = None, onto: Optional[str] = None, threads: Optional[int] = None,
              progress: Progress = None, **keys: Any) -> Curve:
        """The curve of such points in two parameters: `curve(omega=(2, 4), V=(0, 1))`, with the bounds of both.

        onto: which of several curves that meet here, by the type of its points, as "PD".
        """
        if names:
            raise InputError(f"the bounds of {' and '.join(map(str, names))} are missing",
                             f"give them: curve({', '.join(f'{name}=(LEAST, GREATEST)' for name in names)})")
        along, keys = separated("curve", along, keys, self._run._model, "curve()")
        return self._child("curve", {"along": along, **keys}, "curve()", Ways(threads, progress), onto)

    @takes_keys_of("ladder", *_OF_SETTLING)
    def ladder(self, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
               **keys: Any) -> Ladder:
        """The sequence of grazings that begins at this one, each with one contact more, up to the onset of chatter."""
        along, keys = separated("ladder", along, keys, self._run._model, "ladder()")
        along = self._along_as_before() if along is None else along
        return self._child("ladder", {"along": along, **keys}, "ladder()", Ways(threads, progress))

    @takes_keys_of("torus", *_OF_SETTLING)
    def torus(self, *, along: Along = None, threads: Optional[int] = None, progress: Progress = None,
              **keys: Any) -> Tori:
        """The tori of quasi-periodic motion that begin at this torus point. RunFailed for other points."""
        along, keys = separated("torus", along, keys, self._run._model, "torus()")
        along = self._along_as_before() if along is None else along
        return self._child("torus", {"along": along, **keys}, "torus()", Ways(threads, progress))

    def _along_as_before(self) -> Along:
        """The parameter that the branch follows, with its bounds; of a curve or an orbit: nothing."""
        import json

        record = self._run._record
        text = self._run._store.runs.get(self._run.name)
        if record["kind"] not in ("continue", "ladder"):
            return None
        if text is not None and text.given.get("along") is not None:
            along: Along = text.given["along"]
            return along
        settings = json.loads(record["settings"])
        name = str(self._run._followed[0])
        if settings.get("least") is None or settings.get("greatest") is None:
            return name
        return {name: [settings["least"], settings["greatest"]]}

    def plot(self, **keys: Any) -> Any:
        """Draws the orbit: kind="portrait" (with contacts marked) or "history". Other arguments: see `Run.plot`."""
        keys.setdefault("kind", "portrait")
        return self._run.plot(points=[self._name()], **keys)

    def plot_multipliers(self, *, axes: Any = None) -> Any:
        """Draws the multipliers in the complex plane, with the unit circle. Returns the axes."""
        from ._multipliers import draw_multipliers

        if len(self.eigenvalues):
            raise InputError(f"{self._name()} is an equilibrium, which has no multipliers", "look at its `eigenvalues`")
        return draw_multipliers(self.multipliers, f"{self._titled()} of {self._run.name}: {self.type_words}", axes)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Point):
            return NotImplemented
        return bool(self._run._record["fingerprint"] == other._run._record["fingerprint"] and self.number == other.number)

    def __hash__(self) -> int:
        return hash((self._run._record["fingerprint"], self.number))

    def __reduce__(self) -> Tuple[Any, ...]:
        return _restored_point, (self._run, self.number)

    def __copy__(self) -> Point:
        return self

    def _titled(self) -> str:
        return self.label or f"point {self.number}"

    def __repr__(self) -> str:
        rests = len(self.eigenvalues) > 0
        said = f"{'equilibrium' if rests else f'period {self.period:.7g}'}, {'stable' if self.stable else 'unstable'}"
        if not self._run._followed:
            return f"<{self._titled() if rests else 'Orbit'} {self._run.name} of {self._run._record['model_name']}: {said}>"
        where = f"{self.type_words} at {self._run.parameter} = {self.parameter:.9g}"
        return f"<{self._titled()} of {self._run.name}: {where}, {said}>"

    def _repr_html_(self) -> str:
        from ._plot import small_picture

        keys = {"kind": "portrait", "points": [self._name()], "size": 110}
        return small_picture(lambda: self._run._picture(keys), repr(self))


def _restored_point(run: Branch, number: int) -> Point:
    return run[number]
