"""One motion of a model."""

from __future__ import annotations

from . import _graze
from ._errors import InputError, Interrupted
from ._model import Model
from ._progress import told_to
from ._table import Table

_OPTIONS = {"tolerance": 1e-12, "order": 0, "largest_step": 0.0, "step_limit": 100_000_000, "contacts_at_once": 100,
            "touch": 0.0, "minima": False}


class Simulation:
    """A model made ready to be simulated as often as wanted.

    sections, extrema: names of sections whose passages, and expressions whose extrema, are located; quantities: further
    columns of all tables. The other arguments are those of `simulate`.
    """

    def __init__(self, model: Model, *, sections=(), extrema=(), quantities=(), **options):
        unknown = set(options) - set(_OPTIONS)
        if unknown:
            raise TypeError(f"simulations have no option {sorted(unknown)[0]!r}; they have {', '.join(_OPTIONS)}")
        self.model = model
        self._core = _graze.Simulation(model._core, sections=_names(sections), extrema=_names(extrema),
                                       quantities=_names(quantities), **{**_OPTIONS, **options})

    def run(self, *, state=None, mode=None, progress=None, **length) -> "Motion":
        """Computes one motion; the arguments are those of `simulate`."""
        _check_length(length)
        start = None if state is None else _state(self.model, state)
        told, close = told_to(progress, "time")
        try:
            return Motion(self, length, start, mode, self._core.run(length, start, mode, told))
        except KeyboardInterrupt:
            raise Interrupted() from None
        finally:
            close()


def simulate(model: Model, *, time=None, periods=None, contacts=None, after=None, skip=None, phase=None, samples=None,
             every=None, at=None, derivatives=(), dense=False, sections=(), extrema=(), quantities=(), state=None,
             mode=None, progress=None, **options) -> "Motion":
    """Simulates one motion of a model, without missing a contact.

    time, periods, contacts: how long the motion is, in the model's time, in periods of its phase, or in contacts
        (whichever is reached first; 20 periods if none is given).
    after, skip: time, or periods, that pass before what is shown begins.
    samples, every, at: how many samples are taken at equal distances (500; 0 for none), or at which distance, or at
        which times, counted from the beginning of what is shown.
    derivatives: names of initial states and parameters with respect to which derivatives of the states are computed.
    dense: keep the polynomials of all steps, so that `motion(t)` gives the states at any time.
    sections, extrema, quantities: see `Simulation`. state: initial values, a dict by name or a sequence of all.
    tolerance: relative error of each step (1e-12). order, largest_step, step_limit, contacts_at_once, touch, minima:
        as in `graze simulate --help`.
    progress: True for a bar, or a function of the finished fraction (None if unknown) and the time.

    Returns a Motion. Raises InputError for arguments that cannot be used. A motion that ends by itself, as at a
    singularity, is no error: `motion.ending` says how it ended.
    """
    length = {"time": time, "periods": periods, "contacts": contacts, "after": after, "skip": skip, "phase": phase,
              "samples": samples, "every": every, "at": at, "derivatives": derivatives or None, "dense": dense}
    length = {name: value for name, value in length.items() if value is not None}
    simulation = Simulation(model, sections=sections, extrema=extrema, quantities=quantities, **options)
    return simulation.run(state=state, mode=mode, progress=progress, **length)


_LENGTH = ("time", "periods", "contacts", "after", "skip", "phase", "samples", "every", "at", "derivatives", "dense")


def _check_length(length: dict) -> None:
    for name in length:
        if name not in _LENGTH:
            raise TypeError(f"a motion has no argument {name!r}; it has {', '.join(_LENGTH)}")
    if sum(name in length for name in ("samples", "every", "at")) > 1:
        raise InputError("samples, every and at contradict each other", "give one of them")
    for name in ("samples", "periods", "contacts", "skip"):
        if name in length and (not isinstance(length[name], int) or length[name] < 0):
            raise InputError(f"{name} is {length[name]!r}", "give a whole number that is not negative")
    if "samples" in length and length["samples"] == 1:
        raise InputError("one sample has no distance to the next", "give 2 or more, or 0 for none")
    if "derivatives" in length:
        length["derivatives"] = _names(length["derivatives"])
    if "every" in length and not length["every"] > 0:
        raise InputError(f"every is {length['every']}", "give a positive time")


def _names(names) -> list:
    return [str(names)] if isinstance(names, (str, _graze.Expression)) else [str(name) for name in names]


def _state(model: Model, state) -> list:
    if hasattr(state, "items"):
        values = dict(model.initial)
        for name, value in state.items():
            if name not in values:
                raise InputError(f"the model has no state {name!r}", f"it has {', '.join(values)}")
            values[name] = float(value)
        return list(values.values())
    return [float(value) for value in state]


class Motion:
    """A computed motion.

    `motion["x"]` (or `motion.x`) are the sampled values of a state or quantity at the times `motion.t`, `motion.mode`
    the modes. Tables: `samples`, `contacts` (states just before, and with `_after` just after each), `sections`,
    `extrema`, `minima`, `derivatives`, as far as they were asked for. `ending` says how it ended ("end-time",
    "stopped", "singular", ...), `detail` why, `regular` whether as asked; `end_time`, `end_state` and `end_mode` when
    and where; `steps` how many steps of integration were made.
    """

    def __init__(self, simulation, length, state, mode, made):
        self._simulation, self._length, self._state, self._mode = simulation, length, state, mode
        names = [one.name for one in simulation.model.states]
        units = [one.unit for one in simulation.model.states]
        tables = {name: Table(*table) for name, table in made["tables"].items()}
        if made["at"] is not None:
            import numpy

            times = numpy.asarray(length["at"], dtype=float)[: len(made["at"])]
            tables["samples"] = Table(["time", *names], [times, *made["at"].T],
                                      [simulation.model.time_unit, *units])
        self.samples = tables.get("samples", Table(["time", *names], [[] for _ in range(len(names) + 1)]))
        self.contacts = tables["contacts"]
        for name in ("sections", "extrema", "minima", "derivatives"):
            setattr(self, name, tables.get(name))
        self._dense = made["dense"]
        self.ending, self.regular, self.detail = made["ending"], made["regular"], made["detail"]
        self.end_time, self.end_mode, self.steps = made["time"], made["mode"], made["steps"]
        self.end_state = dict(zip(names, made["state"].tolist()))

    @property
    def model(self) -> Model:
        return self._simulation.model

    @property
    def t(self):
        return self.samples["time"]

    def __getitem__(self, name):
        return self.samples[name]

    def __getattr__(self, name):
        if name.startswith("_") or name == "samples":
            raise AttributeError(name)
        return getattr(self.samples, name)

    def __call__(self, times):
        """States at these times, one row each (or one state for one time); NaN outside of the motion. At the time of a
        contact: those just before it. Needs `dense=True`."""
        import numpy

        if self._dense is None:
            raise InputError("the steps of this motion were not kept", "simulate it with dense=True")
        asked = numpy.atleast_1d(numpy.asarray(times, dtype=float))
        states = self._dense.at(asked.ravel().tolist())
        return states[0] if numpy.ndim(times) == 0 else states

    def plot(self, quantities=(), portraits=(), *, axes=None):
        """Draws histories, and portraits of pairs of quantities, with contacts marked. Returns the axes."""
        from ._plot import draw

        pairs = [tuple(map(str, pair)) for pair in portraits]
        figure = self._simulation._core.figure(self._length, self._state, self._mode, _names(quantities), pairs)
        return draw(figure, axes)

    def to_pandas(self):
        """The samples as a pandas DataFrame."""
        return self.samples.to_pandas()

    def to_xarray(self):
        """The samples as an xarray Dataset along `time`."""
        data = self.samples.to_xarray()
        return data.set_coords("time").swap_dims(row="time")

    def __repr__(self):
        return (f"<Motion of {self.model.name}: {len(self.samples)} samples, {len(self.contacts)} contacts, "
                f"ended at {self.end_time:.7g} ({self.ending})>")

    def _repr_html_(self):
        from ._plot import small_picture

        return small_picture(lambda: self.plot(), repr(self))
