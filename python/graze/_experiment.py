"""Experiments with instruments: a generator is stepped through levels, and a record is taken at each."""

from __future__ import annotations

import os
from typing import Any, Dict, Optional

from . import _arguments as checked, _graze
from ._attributes import Fixed
from ._bench import Bench
from ._design_text import ExperimentText
from ._errors import InputError, InstrumentError, Interrupted
from ._progress import Progress, interruptible, telling
from ._record import MeasuredRecords, read_record
from ._table import Table
from ._watchdog import Watchdog


class Experiment(Fixed):
    """A sequence of levels of a generator, with a record at each: docs/experiment.md describes the file.

    experiment: a file; or text: the text of one; keys: its keys, as generator={"port": ...}, limits=..., samples=...,
    sweep=..., settle=..., record=..., resume=..., name=...: alone, or changing those of the file or text (a dict changes
    what it names, None takes a key away).

    `name`, `text`; `levels`, a table of number, frequency (Hz), amplitude (V from peak to peak), direction (1 from below,
    -1 from above, 0) and file; `safe`, the safe amplitude; `rate` and `samples` of each record. All levels are checked
    against the limits. Raises InputError for mistakes (`all` lists them).
    """

    name: str
    text: str
    safe: float
    rate: float
    samples: int

    def __init__(self, experiment: Any = None, *, text: Optional[str] = None, **keys: Any) -> None:
        self._source = ExperimentText(experiment, text, keys, "Experiment()")
        self._core = self._source.read(_graze.Experiment.parsed)
        self.name = self._core.name
        self.text = self._core.text
        self.safe = self._core.safe
        self.rate = self._core.rate
        self.samples = self._core.samples

    @property
    def levels(self) -> Table:
        """The levels: number, frequency (Hz), amplitude (V from peak to peak), direction, and the file of the record."""
        import numpy

        rows = self._core.levels
        return Table(["number", "frequency", "amplitude", "direction", "file"],
                     [*(numpy.array([row[i] for row in rows]) for i in range(4)), [row[4] for row in rows]],
                     ["", "Hz", "V", "", ""])

    def __repr__(self) -> str:
        return f"<Experiment {self.name}: {len(self._core.levels)} levels, {self.samples} samples at {self.rate:g} Hz>"


class Acquisition(Fixed):
    """The records of an experiment: `folder`, `records` (MeasuredRecords in the order of the levels; None: there are none
    yet), and `entries`, a table of them: number, file, frequency, amplitude, direction, told (the amplitude that the
    generator reports), settled, settling (seconds), samples.

    `complete` says whether all are there; `ending` how it ended ("complete", "interrupted", "no-answer", ...) and `detail`
    why; `before` and `recorded` count the records that were there and that were added, `unsettled` those of them whose
    sections did not repeat; `safe` says whether the generator has confirmed its safe amplitude, `unsafe_because` why not, and
    `off` whether its output is off instead.
    """

    experiment: Experiment
    folder: str
    ending: str
    detail: str
    before: int
    recorded: int
    unsettled: int
    safe: bool
    unsafe_because: str
    off: bool

    def __init__(self, experiment: Experiment, folder: str, report: Dict[str, Any]) -> None:
        self.experiment, self.folder = experiment, folder
        self.ending = report["ending"]
        self.detail = report["detail"]
        self.before = report["before"]
        self.recorded = report["recorded"]
        self.unsettled = report["unsettled"]
        self.safe = report["safe"]
        self.unsafe_because = report["unsafe_because"]
        self.off = report["off"]
        self._rows = report["entries"]

    @property
    def complete(self) -> bool:
        """Whether all records are there."""
        return self.ending == "complete"

    @property
    def entries(self) -> Table:
        """The records: number, file, frequency, amplitude, direction, told, settled, settling, samples."""
        import numpy

        names = ("number", "file", "frequency", "amplitude", "direction", "told", "settled", "settling", "samples")
        columns = [[row[i] for row in self._rows] for i in range(len(names))]
        return Table(names, [column if name == "file" else numpy.array(column) for name, column in zip(names, columns)],
                     ["", "", "Hz", "V", "", "V", "", "s", ""])

    @property
    def records(self) -> Optional[MeasuredRecords]:
        """The records in the order of the levels; None: there are none."""
        found = [read_record(os.path.join(self.folder, row[1])) for row in self._rows]
        return MeasuredRecords(found) if found else None

    def __repr__(self) -> str:
        return f"<Acquisition {self.folder}: {len(self._rows)} of {len(self.experiment._core.levels)} records; {self.ending}>"


@interruptible()
def acquire(experiment: Any = None, *, text: Optional[str] = None, output: Any = None, port: Optional[str] = None,
            device: Optional[str] = None, bench: Optional[Bench] = None, progress: Progress = None,
            **keys: Any) -> Acquisition:
    """Carries out an experiment: steps a generator through levels, waits until the system has settled, and records.

    experiment: an `Experiment`, or a file; text, keys: see `Experiment`.
    output: folder of the records (the name of the experiment). Levels that are recorded in it already are not recorded
        again: call it again to continue.
    port, device: where the generator and the samples are (those of the experiment): a serial line, and tcp:HOST:PORT or
        serial:PATH; or bench: a `Bench` in their place, whose time passes only as samples are read.
    progress: True for a bar, or a function of a dict: stage ("walking", "setting", "settling", "recording"), number,
        levels, recorded, frequency, amplitude, direction, time. Where it returns False, the acquisition ends.

    Returns an Acquisition. Whatever happens, the generator is brought to its safe amplitude before this returns or raises;
    if this process is killed, a second one does that. Raises InputError for mistakes in the experiment; InstrumentError
    where an instrument fails or refuses, and where the output could not be made safe; Interrupted after Ctrl-C. The
    attribute `run` of the last two is the Acquisition with the records that are there.
    """
    if isinstance(experiment, Experiment):
        if text is not None or keys:
            raise InputError("acquire() was given an Experiment and keys", "give one of them")
        asked = experiment
    else:
        asked = Experiment(experiment, text=text, **keys)
    core = _graze.Experiment.parsed(asked._source.text, asked._source.file)  # a copy
    if bench is not None:
        if not isinstance(bench, Bench):
            raise InputError(f"bench is a {type(bench).__name__}", "give a graze.Bench")
        if port is not None or device is not None:
            raise InputError("a bench and addresses of instruments are given", "give one of them")
    else:
        if port is not None:
            core.port = checked.text(port, "port")
        if device is not None:
            core.device = checked.text(device, "device")
        if not core.port:
            raise InputError("nothing says where the generator is", "give port, or generator={'port': ...}, or a bench")
        if not core.device:
            raise InputError("nothing says where samples come from", "give device, or samples={'device': ...}, or a bench")
    folder = asked.name if output is None else checked.path_of(output, "a folder", "output")
    return _acquired(asked, core, folder, bench, progress)


def _acquired(asked: Experiment, core: Any, folder: str, bench: Optional[Bench], progress: Progress) -> Acquisition:
    instruments: Any = None if bench is None else bench._core
    interrupted = False
    with telling(progress, "record") as told:
        made = _graze.Acquisition(core, folder)
        watchdog = Watchdog(asked._source, core.port) if bench is None else None
        try:
            made.run(instruments, -1 if watchdog is None else watchdog.fileno(), told)
        except KeyboardInterrupt:
            interrupted = True
        finally:
            if watchdog is not None:
                watchdog.close()
    report = made.report()
    result = Acquisition(asked, folder, report)
    if not result.safe:
        off = "its output is switched off, as it tells itself" if result.off else "switch it off by hand"
        error = InstrumentError(f"the generator could not be brought to its safe amplitude, {asked.safe:g} V "
                                f"({result.unsafe_because}); {result.detail}", off)
        error.run = result
        raise error
    if interrupted:
        raise Interrupted(result) from None
    if not result.complete:
        error = InstrumentError(f"{result.ending}: {result.detail}", report["remedy"])
        error.run = result
        raise error
    return result
