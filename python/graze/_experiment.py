"""Experiments: a simulated bench with a generator and sensors, and acquisition with instruments."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from typing import Any, Callable, Dict, List, Optional, Tuple, Union

from . import _graze
from ._design import DesignText
from ._errors import FileError, InputError, InstrumentError, Interrupted
from ._model import Model, load
from ._output import OwnFolder
from ._progress import Progress, Stopped
from ._record import MeasuredRecord, MeasuredRecords, _number, _text, _whole, read_record
from ._table import Table

_CHANNEL_NUMBERS = ("noise", "bias", "drift", "range")


def _channels(channels: Any) -> List[str]:
    if isinstance(channels, str):
        return [channels]
    if not isinstance(channels, Mapping):
        try:
            return [_text(one, "a channel") for one in channels]
        except TypeError:
            raise InputError(f"channels are {channels!r}", 'give texts as "V=V0*sin(theta):V", or a dict') from None
    texts = []
    for name, value in channels.items():
        parts = value if isinstance(value, (tuple, list)) else (value,)
        if not 1 <= len(parts) <= 2:
            raise InputError(f"channel {name} has {len(parts)} items", "give an expression, or (expression, unit)")
        unit = f":{_text(parts[1], 'a unit')}" if len(parts) == 2 else ""
        texts.append(f"{_text(name, 'a channel')}={parts[0]}{unit}")
    return texts


def _by_channel(values: Any, name: str) -> List[Tuple[str, Union[float, str]]]:
    if not isinstance(values, Mapping):
        raise InputError(f"{name} is {values!r}", f'give a dict, as {name}={{"v": 0.002}}')
    return [(_text(channel, "a channel"), value if isinstance(value, str) else _number(value, f"{name} of {channel}"))
            for channel, value in values.items()]


class Bench:
    """A simulated experiment: a function generator that drives a model, and sensors of its motion, which goes on as long as
    the bench exists. It uses no clock: time passes only by `record` and `wait`, so that the same calls give the same
    samples, bit for bit. Settings of the generator act at once, with continuous phase.

    model: a `graze.Model`, or the name or file of one, with the parameters and initial state at which it begins.
    amplitude: the parameter that is half of the generator's peak-to-peak voltage ("V0"), or "V0=2.5", with the gain of an
        amplifier. frequency: the one that is its frequency in Hz ("f"), or "omega=2*pi". offset: the one that is its offset
        (none: the generator refuses offsets). time_unit: of the model, in seconds.
    channels: what is measured: texts NAME=EXPRESSION:UNIT, or a dict: name -> expression or (expression, unit); without it
        the quantity `voltage`, as V, and all states that are not cyclic.
    noise, bias, drift, range: dicts by channel: standard deviation, constant error, its growth per second, and the range of
        the converter (-range to range, clipped and rounded to `bits`). anti_alias: corner of a low pass in Hz. seed: of the
        noise.
    clip: limits the amplitude without an error. left_as: commands that an earlier user has left in force.

    Raises InputError for settings that cannot be used. `channels` are the names, `units` a dict.
    """

    def __init__(self, model: Any, *, amplitude: str = "V0", frequency: str = "f", offset: Optional[str] = None,
                 time_unit: float = 1.0, channels: Any = None, noise: Any = None, bias: Any = None, drift: Any = None,
                 range: Any = None, bits: int = 16, anti_alias: Optional[float] = None, seed: int = 1,
                 clip: Optional[float] = None, left_as: str = "") -> None:
        self.model = model if isinstance(model, Model) else load(model)
        words: Dict[str, Any] = {
            "amplitude": _text(amplitude, "amplitude"), "frequency": _text(frequency, "frequency"),
            "time_unit": _number(time_unit, "time_unit", above=0), "bits": _whole(bits, "bits", 1, 32),
            "seed": _whole(seed, "seed", 0, 2**64 - 1), "left_as": _text(left_as, "left_as")}
        if offset is not None:
            words["offset"] = _text(offset, "offset")
        if channels is not None:
            words["channels"] = _channels(channels)
        for name, values in zip(_CHANNEL_NUMBERS, (noise, bias, drift, range)):
            if values is not None:
                words[name] = _by_channel(values, name)
        if anti_alias is not None:
            words["anti_alias"] = _number(anti_alias, "anti_alias", above=0)
        if clip is not None:
            words["clip"] = _number(clip, "clip", above=0)
        self._seed = words["seed"]
        self._takes_offset = offset is not None
        self._core = _graze.Bench(self.model._core, words)
        named = self._core.channels
        self.channels: Tuple[str, ...] = tuple(name for name, _ in named)
        self.units: Dict[str, str] = dict(named)

    def drive(self, *, frequency: float, amplitude: float, offset: float = 0.0, shape: str = "sine") -> None:
        """Sets the generator: frequency in Hz, amplitude in V from peak to peak, offset in V; shape: "sine", "square",
        "triangle", "ramp" or "dc", of which the model gets the component at the frequency."""
        if offset != 0 and not self._takes_offset:
            raise InputError(f"offset is {offset!r}, and the bench has no parameter for it",
                             "name it where the bench is made: Bench(..., offset=NAME)")
        self._core.drive(_number(frequency, "frequency", above=0), _number(amplitude, "amplitude", least=0),
                         _number(offset, "offset"), _text(shape, "shape"))

    def command(self, line: str) -> str:
        """Gives the generator a line of SCPI commands, as "SYST:REM;VOLT 3". Returns its answer, which may be empty."""
        return str(self._core.command(_text(line, "the line")))

    def wait(self, seconds: float) -> None:
        """Lets simulated time pass."""
        seconds = _number(seconds, "seconds", least=0)
        self._use(lambda: self._core.pass_(seconds))

    def record(self, time: float, *, rate: float = 1000.0) -> MeasuredRecord:
        """Takes samples for some simulated seconds, at a rate in samples per second; the first of them now. Times count from
        the beginning of the bench. InstrumentError where the motion has ended, as at a singularity."""
        self._core.rate = _number(rate, "rate", above=0)
        count = _whole(round(_number(time, "time", above=0) * rate), "the number of samples", 1, 1_000_000_000)
        times, columns = self._use(lambda: self._core.sample(count))
        if len(times) < count:
            raise InstrumentError(f"the motion has ended after {len(times)} of {count} samples: {self.ended}",
                                  "make another bench")
        return MeasuredRecord(times, dict(zip(self.channels, columns)), units=self.units, time_unit="s", name="bench")

    def _use(self, work: Callable[[], Any]) -> Any:
        try:
            return work()
        except KeyboardInterrupt:
            raise Interrupted() from None

    @property
    def time(self) -> float:
        """Simulated seconds since it was made."""
        return float(self._core.time)

    @property
    def ended(self) -> str:
        """Why the motion has ended; empty while it goes on."""
        return str(self._core.ended)

    def mark(self, number: int) -> None:
        """Stores the state of all but the generator under a number; the last four are kept."""
        self._core.mark(_whole(number, "number", 0, 2**64 - 1))

    def return_to(self, number: int) -> None:
        """Returns to a stored state. InputError where none is stored under that number."""
        if not self._core.return_to(_whole(number, "number", 0, 2**64 - 1)):
            raise InputError(f"no state is stored under {number}", "store it by mark()")

    def serve(self, *, port: Any = None, tcp: int = 0, speed: float = 1.0, on_demand: bool = False, drop: float = 0.0,
              delay: float = 0.0, break_after: int = 0, break_for: float = 1.0, break_samples: int = 0) -> "BenchService":
        """Gives the bench the connections of a real one, as `graze bench` does: see `BenchService`. While they are served
        nothing else may use the bench.

        port: path of the generator's serial line, which is created (one in a temporary folder). tcp: port for samples on
        this machine (a free one). speed: simulated seconds per second; on_demand: time passes only as samples are read.
        drop, delay, break_after, break_for, break_samples: simulated faults: the probability that a character on the serial
        line is lost; seconds until each answer; the line breaks after so many lines, for so many seconds; the connection of
        samples closes after so many rows, each time anew.
        """
        folder = OwnFolder() if port is None else None
        path = os.path.join(folder.path, "generator") if folder is not None else os.fspath(port)
        words = {"port": path, "tcp": _whole(tcp, "tcp", 0, 65535), "speed": _number(speed, "speed", above=0),
                 "on_demand": bool(on_demand), "drop": _number(drop, "drop", least=0),
                 "delay": _number(delay, "delay", least=0), "break_after": _whole(break_after, "break_after", 0, 10**9),
                 "break_for": _number(break_for, "break_for", least=0),
                 "break_samples": _whole(break_samples, "break_samples", 0, 10**9), "seed": self._seed}
        return BenchService(_graze.BenchService(self._core, words), path, folder)

    def __repr__(self) -> str:
        channels = ", ".join(f"{name} [{unit}]" if unit else name for name, unit in self.units.items())
        return f"<Bench of {self.model.name}: {channels}>"


def bench(model: Any, **settings: Any) -> Bench:
    """Makes a simulated experiment, a generator that drives a model, and sensors; the settings are those of `Bench`.

        bench = graze.bench("electromagnetic-testbed", amplitude="V0=2", noise={"v": 0.002})
        bench.drive(frequency=6.1, amplitude=4.8)
        record = bench.record(5)
    """
    return Bench(model, **settings)


class BenchService:
    """The connections of a bench: `generator`, the path of a pseudo-terminal that answers like an HP 33120A generator, and
    `samples`, the address tcp:HOST:PORT of its samples. They end by `close()`, or at the end of `with bench.serve() as
    service:`."""

    def __init__(self, core: Any, generator: str, folder: Optional[OwnFolder]) -> None:
        self._core, self._folder = core, folder
        self.generator = generator
        self.samples = f"tcp:127.0.0.1:{core.tcp_port}"

    def close(self) -> None:
        """Ends the connections; the bench can be used otherwise again."""
        self._core = None

    def __enter__(self) -> "BenchService":
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<BenchService: generator {self.generator}, samples {self.samples}{'' if self._core else ', closed'}>"


class _ExperimentText(DesignText):
    """The text of an experiment file, and what is changed of it."""

    def _read(self, design: Any) -> Tuple[str, str]:
        try:
            self.path = os.fspath(design)
        except TypeError:
            raise InputError(f"{self.called} was given a {type(design).__name__} as the experiment",
                             "give a file, or the keys of one") from None
        try:
            with open(self.path, encoding="utf-8") as file:
                return self.path, file.read()
        except OSError as error:
            raise FileError(f"the experiment '{self.path}' cannot be read: {error.strerror}", "name a file") from None
        except UnicodeDecodeError:
            raise FileError(f"the experiment '{self.path}' is no text in UTF-8", "name another file") from None


class Experiment:
    """A sequence of levels of a generator, with a record at each: docs/experiment.md describes the file.

    experiment: a file; or text: the text of one; keys: its keys, as generator={"port": ...}, limits=..., samples=...,
    sweep=..., settle=..., record=..., resume=..., name=...: alone, or changing those of the file or text (a dict changes
    what it names, None takes a key away).

    `name`, `text`; `levels`, a table of number, frequency (Hz), amplitude (V from peak to peak), direction (1 from below,
    -1 from above, 0) and file; `safe`, the safe amplitude; `rate` and `samples` of each record. All levels are checked
    against the limits. Raises InputError for mistakes (`all` lists them).
    """

    def __init__(self, experiment: Any = None, *, text: Optional[str] = None, **keys: Any) -> None:
        self._source = _ExperimentText(experiment, text, keys, "Experiment()")
        self._core = self._source.read(_graze.Experiment.parsed)
        self.name: str = self._core.name
        self.text: str = self._core.text
        self.safe: float = self._core.safe
        self.rate: float = self._core.rate
        self.samples: int = self._core.samples

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


class Acquisition:
    """The records of an experiment: `folder`, `records` (MeasuredRecords in the order of the levels; None: there are none
    yet), and `entries`, a table of them: number, file, frequency, amplitude, direction, told (the amplitude that the
    generator reports), settled, settling (seconds), samples.

    `complete` says whether all are there; `ending` how it ended ("complete", "interrupted", "no-answer", ...) and `detail`
    why; `before` and `recorded` count the records that were there and that were added, `unsettled` those of them whose
    sections did not repeat; `safe` says whether the generator has confirmed its safe amplitude, `unsafe_because` why not, and
    `off` whether its output is off instead.
    """

    def __init__(self, experiment: Experiment, folder: str, report: Dict[str, Any]) -> None:
        self.experiment, self.folder = experiment, folder
        self.ending: str = report["ending"]
        self.detail: str = report["detail"]
        self.before: int = report["before"]
        self.recorded: int = report["recorded"]
        self.unsettled: int = report["unsettled"]
        self.safe: bool = report["safe"]
        self.unsafe_because: str = report["unsafe_because"]
        self.off: bool = report["off"]
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


_WATCH = "import sys; sys.path[:] = sys.argv[3:]; from graze._experiment import _watch; _watch(*sys.argv[1:3])"


def _watch(file: str, port: str) -> None:
    """The second process, which survives when the first is killed: it then brings the generator to its safe amplitude."""
    import signal

    for one in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGPIPE):
        signal.signal(one, signal.SIG_IGN)
    text = sys.stdin.buffer.read(int(sys.stdin.buffer.readline()))
    experiment = _graze.Experiment.parsed(text.decode(), file)
    experiment.port = port
    armed = False
    for letter in iter(lambda: sys.stdin.buffer.read(1), b""):
        armed = letter == b"a"
    if armed:
        problem = experiment.make_safe()
        told = (f"the generator could not be brought to its safe amplitude ({problem}): switch it off by hand" if problem
                else f"the generator is off, or at its safe amplitude, {experiment.safe:g} V")
        print(f"graze: acquire was killed; {told}", file=sys.stderr)


class _Watchdog:
    """The process that makes the generator safe if this one is killed."""

    def __init__(self, source: DesignText, port: str) -> None:
        import subprocess

        text = source.text.encode()
        try:
            self._process = subprocess.Popen([sys.executable, "-c", _WATCH, source.file, port, *sys.path],
                                             stdin=subprocess.PIPE, start_new_session=True)
        except OSError as error:
            raise InstrumentError(f"the process that makes the generator safe cannot be started: {error.strerror}",
                                  "look whether sys.executable is Python") from None
        stream = self._process.stdin
        assert stream is not None
        self._stream = stream
        stream.write(b"%d\n" % len(text) + text)
        stream.flush()

    def fileno(self) -> int:
        return self._stream.fileno()

    def close(self) -> None:
        """The generator is safe, or everything possible has been tried."""
        try:
            self._stream.write(b"d")
            self._stream.close()
        except OSError:
            pass
        self._process.wait()


def _told(progress: Progress) -> Tuple[Optional[Callable[[Dict[str, Any]], None]], Callable[[], None]]:
    if progress is None or progress is False:
        return None, lambda: None
    if progress is not True:
        if not callable(progress):
            raise TypeError(f"progress must be True or a function, not {type(progress).__name__}")
        asked = progress

        def tell(state: Dict[str, Any]) -> None:
            if asked(state) is False:
                raise Stopped

        return tell, lambda: None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None, lambda: None
    bar = tqdm(unit="record")

    def show(state: Dict[str, Any]) -> None:
        bar.total, bar.n = state["levels"] or None, state["recorded"]
        bar.set_postfix_str(f"{state['stage']} {state['frequency']:g} Hz, {state['amplitude']:g} V", refresh=False)
        bar.refresh()

    return show, bar.close


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
            core.port = _text(port, "port")
        if device is not None:
            core.device = _text(device, "device")
        if not core.port:
            raise InputError("nothing says where the generator is", "give port, or generator={'port': ...}, or a bench")
        if not core.device:
            raise InputError("nothing says where samples come from", "give device, or samples={'device': ...}, or a bench")
    try:
        folder = os.fspath(output) if output is not None else asked.name
    except TypeError:
        raise InputError(f"output is {output!r}", "name a folder") from None
    return _acquired(asked, core, folder, bench, progress)


def _acquired(asked: Experiment, core: Any, folder: str, bench: Optional[Bench], progress: Progress) -> Acquisition:
    told, close = _told(progress)
    made = _graze.Acquisition(core, folder)
    watchdog = _Watchdog(asked._source, core.port) if bench is None else None
    instruments: Any = None if bench is None else bench._core
    interrupted = False
    try:
        made.run(instruments, -1 if watchdog is None else watchdog.fileno(), told)
    except KeyboardInterrupt:
        interrupted = True
    finally:
        if watchdog is not None:
            watchdog.close()
        close()
    report = made.report()
    result = Acquisition(asked, folder, report)
    if not result.safe:
        off = "its output is switched off, as it tells itself" if result.off else "switch it off by hand"
        error = InstrumentError(f"the generator could not be brought to its safe amplitude, {asked.safe:g} V "
                                f"({result.unsafe_because}); {result.detail}", off)
        setattr(error, "run", result)
        raise error
    if interrupted:
        raise Interrupted(result) from None
    if not result.complete:
        error = InstrumentError(f"{result.ending}: {result.detail}", report["remedy"])
        setattr(error, "run", result)
        raise error
    return result
