"""What can be asked of one point of a branch: what a grazing leads to, how long a trip takes, how the point depends on
other parameters, where a ladder of grazings ends, and what certifies the orbit."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any, Dict, Optional

from . import _arguments as checked, _graze
from ._analysis import called
from ._certificate import Certificate, counted
from ._chatter import Chatter
from ._errors import InputError, Interrupted
from ._grazing import Grazing
from ._progress import Progress, attended, interruptible
from ._table import Table
from ._tolerance import Tolerance, interval_text, tolerance_texts
from ._trips import AskedTrips, Trips, check_together


class PointAnalyses:
    """What can be asked of a point of a branch; `Point` has all of it."""

    _run: Any
    label: str
    number: int

    def _name(self) -> str:
        return self.label or str(self.number)

    def _start(self) -> Dict[str, Any]:
        """What says in a study that a run starts from here, with the run as an object."""
        return {"run": self._run, "point": self._name()}

    def _named(self) -> str:
        return f"{self._run.name}:{self._name()}"

    def _own_file(self) -> Any:
        """The results by a connection of their own, so that others can read them while something is computed."""
        return _graze.ResultFile(self._run._store.path, write=False)

    @interruptible()
    def grazing(self, *, parameter: Optional[str] = None, verify: bool = False) -> Grazing:
        """Whether an attractor survives this grazing or is lost, and how contacts grow beyond it.

        parameter: what moves the orbit through the grazing (the parameter of its run).
        verify: check the verdict by simulation near the grazing (`grazing.trial`).

        Raises InputError where the orbit does not touch.
        """
        with called("grazing()"):
            name, verified = checked.optional_name(parameter, "parameter"), checked.truth(verify, "verify")
            try:
                made = _graze.grazing(self._own_file(), self._named(), parameter=name, verify=verified)
            except KeyboardInterrupt:
                raise Interrupted() from None
        return Grazing(self._named(), made)

    @interruptible()
    def trip(self, *, overshoot: Any = None, parameter: Optional[str] = None, beside: Optional[PointAnalyses] = None,
             disturbance: Optional[Mapping[str, Any]] = None, until: Any = None, greatest_speed: Optional[float] = None,
             cycles: Optional[int] = None, ramp: Any = None, wave: Any = None, wave_period: Optional[float] = None,
             noise: Any = None, memory: Optional[float] = None, at: Any = None, motions: Optional[int] = None,
             seed: Optional[int] = None, threads: Optional[int] = None, progress: Progress = None) -> Trips:
        """How long a motion takes to be lost beyond this grazing (with the verdict "lost") or fold.

        The parameter is moved beyond the point at once, by each overshoot; or it changes in time:
        overshoot: signed distances beyond the point: a number, several, or a text in which "1e-2:1e-20" stands for one in
            each decade (that, times the size of the parameter, if nothing else is asked for).
        ramp: rates per unit of time, for a linear rise or fall.
        wave: amplitudes of an oscillation about `at`; wave_period: its period in cycles of the orbit (100).
        noise: standard deviations of a noise about `at` that is constant in each cycle; memory: its correlation time in
            cycles (0); motions: how many are simulated at each level (1000); seed (1).
        at: the value of the parameter that is disturbed, before the point; for a ramp, its first value.

        until: what ends trips: "q=0.9" or ("q", 0.9), where an expression reaches a level, or "end", where the motion
            itself ends. greatest_speed: the first contact with this approach speed. Otherwise the limit of the map, or
            the passage of the fold.
        cycles: the largest number of simulated cycles (2000; 100 under noise).
        disturbance: of the initial state, a dict by name. parameter: what is moved (the parameter of the run).
        beside: another point, to compare overshoots of the same size.
        threads: for noise (all cores); results do not depend on it. progress: see `graze.sweep`.

        Raises InputError for arguments that contradict each other, and where the motion is not lost at the point;
        Interrupted, whose `run` has the finished rows.
        """
        with called("trip()"):
            check_together(overshoot=overshoot, disturbance=disturbance, beside=beside, ramp=ramp, wave=wave,
                            wave_period=wave_period, noise=noise, memory=memory, at=at, motions=motions, seed=seed,
                            until=until, greatest_speed=greatest_speed)
            if beside is not None and not isinstance(beside, PointAnalyses):
                raise checked.wrong(beside, "beside", "is no point", "give another point")
            asked = AskedTrips(parameter, until, greatest_speed, at, cycles)
            if ramp is not None:
                work = asked.ramp(ramp)
            elif wave is not None:
                work = asked.wave(wave, wave_period)
            elif noise is not None:
                work = asked.noise(noise, memory, motions, seed, threads)
            else:
                work = asked.beyond(overshoot, beside, disturbance)
            return asked.computed(self, work, progress)

    @interruptible()
    def tolerance(self, *, parameter: Optional[str] = None, vary: Optional[Mapping[str, Any]] = None, within: Any = None,
                  devices: int = 10_000, seed: int = 1, threads: Optional[int] = None, executor: Any = None,
                  progress: Progress = None) -> Tolerance:
        """How the value of the parameter at which this point lies depends on all other parameters: exact derivatives, and
        with `vary` the statistics over devices that differ, each solved for by Newton's method.

        parameter: whose value follows from the others (the parameter of the run).
        vary: a dict of the parameters that differ: a number is a standard deviation, "1%" one relative to the value,
            (0.01, "uniform") or ("1%", "uniform") the half width of a uniform distribution.
        within: (low, high), acceptable values, of which the yield is computed; one of them may be None.
        devices, seed: how many devices are drawn at random. threads: all cores; results do not depend on it.
        executor: a concurrent.futures.Executor whose workers solve for the devices, in place of threads; the results are
            the same.
        progress: see `graze.sweep`.

        Raises InputError for a point whose value does not follow from other parameters; Interrupted, or WorkersLost of an
        executor, whose `run` has the devices that were made.
        """
        from ._executors import handed_out

        with called("tolerance()"):
            if vary is None and within is not None:
                raise InputError("without tolerances all devices are alike", 'say what differs: vary={"name": "1%"}',
                                 "within")
            name = checked.optional_name(parameter, "parameter")
            varied = None if vary is None else tolerance_texts(vary)
            interval = interval_text(within)
            devices, seed = checked.whole(devices, "devices"), checked.whole(seed, "seed", 0)
            threads = checked.number_of_threads(threads)
            core = None
            with attended(progress, "point", lambda: Tolerance(core, seed) if core and core.has_yield else None) as told, \
                    handed_out(executor, told) as (parts, look):
                core = _graze.LocatedPoint(self._own_file(), self._named(), name)
                if varied is not None:
                    core.make_devices(varied, within=interval, devices=devices, seed=seed, threads=threads, told=look,
                                      parts=parts)
        return Tolerance(core, seed)

    @interruptible()
    def chatter(self, *, parameter: Optional[str] = None, rungs: int = 8, progress: Progress = None) -> Chatter:
        """The ladder of grazings that begins at this one, and the onset of chatter to which it leads, from the motion
        and from the grazings alone. `ladder` computes the same grazings as a run, with their orbits.

        rungs: the largest number of grazings, this one included. parameter: what varies (the parameter of the run).
        progress: see `graze.sweep`.

        Raises InputError where no ladder begins; Interrupted, whose `run` has the grazings that were reached.
        """
        with called("chatter()"):
            name = checked.optional_name(parameter, "parameter")
            core = _graze.LadderOfGrazings(self._named(), name, checked.whole(rungs, "rungs"))
            with attended(progress, "point", lambda: Chatter(core.object()) if core.has_grazings else None) as told:
                core.climb(self._own_file(), told)
        return Chatter(core.object())

    @interruptible()
    def motion(self, samples: int = 500, *, quantities: Any = ()) -> Table:
        """The motion along one whole period, segment by segment, with both sides of every jump.

        samples: about how many rows. quantities: names or expressions, for further columns.
        Columns: the time `t`, the states, the quantities, and the `segment` (from 1), its `mode` and its `end`.

        Raises InputError for what is no quantity. Where the motion cannot be followed to the end of a segment, it warns,
        and the table has what there is.
        """
        with called("motion()"):
            names = checked.names(quantities, "quantities")
            count = checked.whole(samples, "samples", 2, 10_000_000)
            (columns, arrays, units), problems = _graze.orbit_motion(self._own_file(), self._named(),
                                                                     names, count)
        for problem in problems:
            warnings.warn(problem, RuntimeWarning, stacklevel=4)
        order = [*range(3, len(columns)), 0, 1, 2]
        return counted(*([items[one] for one in order] for items in (columns, arrays, units)))

    def certificate(self) -> Certificate:
        """What certifies that the model would follow this orbit, and how close other events come."""
        with called("certificate()"), self._run._store.reading() as file:
            return Certificate(_graze.certificate(file, self._named()))
