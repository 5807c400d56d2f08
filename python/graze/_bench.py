"""A simulated experiment: a generator that drives a model, and sensors."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Dict, List, Optional, Tuple, Union

from . import _arguments as checked, _graze
from ._attributes import Fixed
from ._errors import InputError, InstrumentError
from ._model import Model, load
from ._output import OwnFolder
from ._progress import interruptible
from ._record import MeasuredRecord

_CHANNEL_NUMBERS = ("noise", "bias", "drift", "range")


def _channels(channels: Any) -> List[str]:
    if isinstance(channels, str):
        return [checked.text(channels, "channels")]
    if not isinstance(channels, Mapping):
        try:
            return [checked.text(one, "a channel") for one in channels]
        except TypeError:
            raise InputError(f"channels are {channels!r}", 'give texts as "V=V0*sin(theta):V", or a dict') from None
    texts = []
    for name, value in channels.items():
        parts = value if isinstance(value, (tuple, list)) else (value,)
        if not 1 <= len(parts) <= 2:
            raise InputError(f"channel {name} has {len(parts)} items", "give an expression, or (expression, unit)")
        unit = f":{checked.text(parts[1], 'a unit')}" if len(parts) == 2 else ""
        texts.append(f"{checked.text(name, 'a channel')}={checked.expression(parts[0], f'channel {name}')}{unit}")
    return texts


def _by_channel(values: Any, name: str) -> List[Tuple[str, Union[float, str]]]:
    if not isinstance(values, Mapping):
        raise InputError(f"{name} is {values!r}", f'give a dict, as {name}={{"v": 0.002}}')
    return [(checked.text(channel, "a channel"),
             checked.text(value, name) if isinstance(value, str) else checked.number(value, f"{name} of {channel}"))
            for channel, value in values.items()]


class Bench(Fixed):
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

    model: Model
    channels: Tuple[str, ...]
    units: Dict[str, str]

    def __init__(self, model: Any, *, amplitude: str = "V0", frequency: str = "f", offset: Optional[str] = None,
                 time_unit: float = 1.0, channels: Any = None, noise: Any = None, bias: Any = None, drift: Any = None,
                 range: Any = None, bits: int = 16, anti_alias: Optional[float] = None, seed: int = 1,
                 clip: Optional[float] = None, left_as: str = "") -> None:
        self.model = model if isinstance(model, Model) else load(model)
        words: Dict[str, Any] = {
            "amplitude": checked.text(amplitude, "amplitude"), "frequency": checked.text(frequency, "frequency"),
            "time_unit": checked.number(time_unit, "time_unit", above=0), "bits": checked.whole(bits, "bits", 1, 32),
            "seed": checked.whole(seed, "seed", 0, 2**64 - 1), "left_as": checked.text(left_as, "left_as")}
        if offset is not None:
            words["offset"] = checked.text(offset, "offset")
        if channels is not None:
            words["channels"] = _channels(channels)
        for name, values in zip(_CHANNEL_NUMBERS, (noise, bias, drift, range)):
            if values is not None:
                words[name] = _by_channel(values, name)
        if anti_alias is not None:
            words["anti_alias"] = checked.number(anti_alias, "anti_alias", above=0)
        if clip is not None:
            words["clip"] = checked.number(clip, "clip", above=0)
        self._seed = words["seed"]
        self._takes_offset = offset is not None
        self._core = _graze.Bench(self.model._core, words)
        named = self._core.channels
        self.channels = tuple(name for name, _ in named)
        self.units = dict(named)

    def drive(self, *, frequency: float, amplitude: float, offset: float = 0.0, shape: str = "sine") -> None:
        """Sets the generator: frequency in Hz, amplitude in V from peak to peak, offset in V; shape: "sine", "square",
        "triangle", "ramp" or "dc", of which the model gets the component at the frequency."""
        offset = checked.number(offset, "offset")
        if offset != 0 and not self._takes_offset:
            raise InputError(f"offset is {offset!r}, and the bench has no parameter for it",
                             "name it where the bench is made: Bench(..., offset=NAME)")
        self._core.drive(checked.number(frequency, "frequency", above=0), checked.number(amplitude, "amplitude", least=0),
                         offset, checked.text(shape, "shape"))

    def command(self, line: str) -> str:
        """Gives the generator a line of SCPI commands, as "SYST:REM;VOLT 3". Returns its answer, which may be empty."""
        return str(self._core.command(checked.text(line, "the line")))

    def wait(self, seconds: float) -> None:
        """Lets simulated time pass."""
        seconds = checked.number(seconds, "seconds", least=0)
        with interruptible():
            self._core.pass_(seconds)

    def record(self, time: float, *, rate: float = 1000.0) -> MeasuredRecord:
        """Takes samples for some simulated seconds, at a rate in samples per second; the first of them now. Times count from
        the beginning of the bench. InstrumentError where the motion has ended, as at a singularity."""
        rate = checked.number(rate, "rate", above=0)
        self._core.rate = rate
        seconds = checked.number(time, "time", above=0)
        count = checked.whole(round(seconds * rate), "the number of samples", 1, 1_000_000_000)
        with interruptible():
            times, columns = self._core.sample(count)
        if len(times) < count:
            raise InstrumentError(f"the motion has ended after {len(times)} of {count} samples: {self.ended}",
                                  "make another bench")
        return MeasuredRecord(times, dict(zip(self.channels, columns)), units=self.units, time_unit="s", name="bench")

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
        self._core.mark(checked.whole(number, "number", 0, 2**64 - 1))

    def return_to(self, number: int) -> None:
        """Returns to a stored state. InputError where none is stored under that number."""
        if not self._core.return_to(checked.whole(number, "number", 0, 2**64 - 1)):
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
        path = os.path.join(folder.path, "generator") if folder is not None else checked.path_of(port, "a serial line")
        words = {"port": path, "tcp": checked.whole(tcp, "tcp", 0, 65535), "speed": checked.number(speed, "speed", above=0),
                 "on_demand": checked.truth(on_demand, "on_demand"), "drop": checked.number(drop, "drop", least=0),
                 "delay": checked.number(delay, "delay", least=0),
                 "break_after": checked.whole(break_after, "break_after", 0, 10**9),
                 "break_for": checked.number(break_for, "break_for", least=0),
                 "break_samples": checked.whole(break_samples, "break_samples", 0, 10**9), "seed": self._seed}
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
