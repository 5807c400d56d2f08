"""Measured records: tables of channels against time, and what is computed from them."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, Dict, Iterable, Iterator, List, NamedTuple, Optional, Tuple, Union

from . import _arguments as checked, _graze
from ._attributes import Fixed
from ._errors import InputError, Interrupted
from ._output import OwnFolder, Replacement
from ._record_arguments import PROCESSING, READING, processing_words, table_words
from ._runs import identify, record
from ._table import Table


class PeriodFit(NamedTuple):
    """The period of a record, by a straight line through the times at which its reference rises through a level.

    `period`, `begin` (of the first one) and their standard errors `error`, `begin_error`; `jitter`, the standard
    deviation of the times about the line; the number of whole `periods`; `amplitude` of the reference, averaged.
    """

    period: float
    error: float
    begin: float
    begin_error: float
    jitter: float
    periods: int
    amplitude: float


class HarmonicFit(NamedTuple):
    """The least-squares fit of offset + sine sin(frequency t) + cosine cos(frequency t), with standard errors for white
    noise: `amplitude` and `phase` (in radians) are those of amplitude sin(frequency t + phase); `covariance` is that of
    sine and cosine; `noise` the standard deviation of the residuals."""

    frequency: float
    offset: float
    offset_error: float
    sine: float
    sine_error: float
    cosine: float
    cosine_error: float
    covariance: float
    amplitude: float
    amplitude_error: float
    phase: float
    phase_error: float
    noise: float
    samples: int


class _RecordTables:
    """What is computed from one record, or from several whose channels and units agree."""

    _cores: List[Any]

    def _computed(self, function: Any, *arguments: Any) -> Any:
        try:
            return function(*arguments)
        except KeyboardInterrupt:
            raise Interrupted() from None
        finally:
            self._tell_remarks()

    def _tell_remarks(self) -> None:
        pass

    def table(self, what: str, **given: Any) -> Table:
        """A table by its name in `graze record --what`: channels, samples, periods, sections, extremes, spectrum or
        impacts; with the arguments of the function of that name. Of several records, the first column tells which."""
        words = table_words(what, given)
        return Table(*self._computed(_graze.record_table, self._cores, checked.text(what, "what"), words))

    def summary(self, *, channels: Any = None) -> Table:
        """Each channel: least, greatest, mean, standard deviation; number of samples, begin, end, shortest and longest
        step of the record."""
        return self.table("channels", channels=channels)

    def periods(self, reference: str, *, channels: Any = None, level: Optional[float] = None,
                hysteresis: Optional[float] = None) -> Table:
        """Each period of a reference channel: begin, duration, amplitude of each channel.

        reference: periods begin where this channel rises through `level` (0), having been `hysteresis` below it, and
            before it is as far above (a tenth of its range, against noise).
        """
        return self.table("periods", reference=reference, channels=channels, level=level, hysteresis=hysteresis)

    def sections(self, reference: str, *, phases: Any = 0, negate: Any = None, channels: Any = None,
                 level: Optional[float] = None, hysteresis: Optional[float] = None) -> Table:
        """All channels at phases (parts of a period, 0 <= phase < 1, one or several) of each period of a reference
        channel, with the amplitude of the reference.

        negate: channels whose sign the symmetric image half a period later changes; images are added as rows.
        """
        return self.table("sections", reference=reference, phases=phases, negate=negate, channels=channels, level=level,
                          hysteresis=hysteresis)

    def extremes(self, reference: str, *, channels: Any = None, level: Optional[float] = None,
                 hysteresis: Optional[float] = None) -> Table:
        """Least and greatest value of each channel in each period of a reference channel, their times and difference."""
        return self.table("extremes", reference=reference, channels=channels, level=level, hysteresis=hysteresis)

    def spectrum(self, channel: str, *, part: Optional[int] = None) -> Table:
        """Amplitudes of a channel by frequency; averaged over parts of so many samples, or of the record as one part."""
        return self.table("spectrum", channel=channel, part=part)

    def impacts(self, channel: str, *, displacement: Optional[str] = None, window: Optional[int] = None,
                transition: Optional[int] = None, least_jump: Optional[float] = None) -> Table:
        """Jumps of a velocity channel: time, velocity before and after, standard errors, ratio.

        displacement: a channel whose corners tell the times. window: samples on each side to which velocities are fitted
        (12). transition: samples on each side that the impact itself disturbs (0). least_jump: smaller jumps are none.
        """
        return self.table("impacts", channel=channel, displacement=displacement, window=window, transition=transition,
                          least_jump=least_jump)

    def _written(self, folder: str) -> List[str]:
        """Writes the records into a folder. Returns their names."""
        raise NotImplementedError

    def fit(self, model: Any, *, threads: Optional[int] = None, progress: Any = None, **keys: Any) -> Any:
        """Finds parameters and initial states of a model by least squares through impacts: `graze.identify` with
        what="fit", whose keys are those of this function: `record.fit(model, unknowns=["zeta", "e"], readings=["x"])`.

        Returns a graze.Identification; raises as `graze.identify` does.
        """
        if "what" in keys or "records" in keys:
            raise InputError("fit() was given what and records", "they are known; use graze.identify for others")
        folder = OwnFolder()
        read = record(files=self._written(folder.path), folder=folder)
        return identify(model, read, what="fit", threads=threads, progress=progress, **keys)

    def plot(self, what: str = "samples", *, axes: Any = None, **given: Any) -> Any:
        """Draws a table by its name, as `graze record --plot` does; the arguments are those of `table`. Returns the
        axes."""
        from ._plot import draw

        words = table_words(what, given)
        return draw(self._computed(_graze.record_figure, self._cores, checked.text(what, "what"), words), axes)

    def _repr_html_(self) -> str:
        from ._plot import small_picture

        def drawn() -> Any:
            return _graze.record_figure(self._cores, "samples", {}) if self._bytes() < _QUICKLY_READ else None

        return str(small_picture(drawn, repr(self)))

    def _bytes(self) -> int:
        """Size of the files."""
        return 0


_QUICKLY_READ = 20_000_000  # bytes


class MeasuredRecord(Fixed, _RecordTables):
    """A table of measured channels against time.

    `read_record(path)` reads one; `MeasuredRecord(times, {"V": values}, units={"V": "V"})` makes one of arrays, which are
    copied. `record["V"]` (or `record.V`) is a channel, `record.t` are the times, as numpy arrays; `samples` is the table of
    all. `channels` are the names, `units` a dict, `time_unit` that of the times. Files are read part by part: only
    `samples` needs memory for the whole record. `remarks` says what was left out of the file.

    Records can be copied and pickled; pickles have all samples. Raises InputError unless each channel has a finite value
    at each time, and times rise.
    """

    name: str
    channels: Tuple[str, ...]
    units: Dict[str, str]
    time_unit: str

    def __init__(self, times: Any, channels: Any, *, units: Optional[Mapping[str, str]] = None, time_unit: str = "",
                 name: str = "record") -> None:
        if not isinstance(channels, Mapping):
            raise InputError(f"channels are a {type(channels).__name__}", "give a dict: name -> values")
        units = {} if units is None else checked.a_dict(units, "units", '{"V": "V"}')
        for one in units:
            if one not in channels:
                raise InputError(f"there is no channel {one!r} for the unit", f"there are {', '.join(map(str, channels))}")
        named = [(checked.text(one, "a channel"), checked.text(units.get(one, ""), "a unit")) for one in channels]
        arrays = [_array(values, one) for one, values in channels.items()]
        self._take(_graze.Record.of_arrays(checked.text(name, "name"), ("t", checked.text(time_unit, "time_unit")),
                                           _array(times, "times"), named, arrays), [])

    @classmethod
    def _of(cls, core: Any, inputs: List[Tuple[str, str]]) -> MeasuredRecord:
        record = cls.__new__(cls)
        record._take(core, inputs)
        return record

    def __copy__(self) -> MeasuredRecord:
        return self  # nothing of it changes

    def __deepcopy__(self, memo: Any) -> MeasuredRecord:
        return self

    def __reduce__(self) -> Tuple[Any, ...]:
        samples = self.samples
        return _record_again, (self.name, self._core.time, self.t, list(self.units.items()),
                               [samples[name] for name in self.channels], self._inputs, self.remarks)

    def _take(self, core: Any, inputs: List[Tuple[str, str]], remarks: Sequence[str] = ()) -> None:
        self._core, self._cores, self._inputs = core, [core], inputs
        self._samples: Optional[Table] = None
        self._told = 0
        self._earlier = list(remarks)  # of the record that was pickled
        self.name = core.name
        self.channels = tuple(name for name, _ in core.channels)
        self.units = dict(core.channels)
        self.time_unit = core.time[1]
        self._tell_remarks()

    def _tell_remarks(self) -> None:
        for text in self._core.remarks[self._told:]:
            self._told += 1
            warnings.warn(text, stacklevel=5)

    def _bytes(self) -> int:
        return sum(os.path.getsize(path) for _, path in self._inputs if os.path.isfile(path))

    @property
    def remarks(self) -> List[str]:
        """What was left out of the file, as far as it has been read: rows with missing values, a last line that was cut
        off. Each is a warning too."""
        return [*self._earlier, *self._core.remarks]

    @property
    def samples(self) -> Table:
        """All samples, read once and kept: the times and each channel as arrays."""
        if self._samples is None:
            self._samples = Table(*self._computed(self._core.samples))
        return self._samples

    @property
    def t(self) -> Any:
        """The times, as an array."""
        return self.samples[self._core.time[0]]

    def __getitem__(self, channel: str) -> Any:
        if channel not in self.units:
            raise KeyError(f"the record has no channel {channel!r}; it has {', '.join(self.channels)}")
        return self.samples[channel]

    def __getattr__(self, channel: str) -> Any:
        if channel.startswith("_") or channel not in self.__dict__.get("units", ()):
            raise AttributeError(f"the record has no channel or attribute {channel!r}")
        return self.samples[channel]

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *(name for name in self.channels if name.isidentifier())]

    def __iter__(self) -> Iterator[str]:
        return iter(self.channels)

    def processed(self, *, scale: Any = None, from_: Optional[float] = None, to: Optional[float] = None,
                  pass_: Optional[float] = None, stop: Optional[float] = None, every: Optional[int] = None,
                  derivative: Optional[str] = None, half_width: Optional[int] = None) -> MeasuredRecord:
        """The record after these steps, in this order; nothing is read before it is needed.

        scale: what readings mean: {"q": factor}, or {"q": (factor, offset, unit)}.
        from_, to: rows from this time on, and up to this time.
        pass_, stop: a symmetric low pass, which delays nothing: frequencies up to pass_ remain, those from stop
            (1.5 pass_) on are taken away. every: one of so many samples is kept, without what is too fast for them.
        derivative: a channel whose derivative, and its standard error, become channels `..._rate` and `..._rate_error`;
            half_width: samples on each side that tell it (those for which its error is least).
        """
        given = {"scale": scale, "from_": from_, "to": to, "pass_": pass_, "stop": stop, "every": every,
                 "derivative": derivative, "half_width": half_width}
        return MeasuredRecord._of(self._core.processed(processing_words(given)), self._inputs)

    def period(self, reference: str, *, level: float = 0.0, hysteresis: Optional[float] = None) -> PeriodFit:
        """The period of a reference channel, by all times at which it rises through a level (see `periods`)."""
        noise = 0.0 if hysteresis is None else checked.number(hysteresis, "hysteresis", above=0)
        return PeriodFit(**self._computed(self._core.period, checked.text(reference, "reference"),
                                          checked.number(level, "level"), noise))

    def harmonic(self, channel: str, frequency: float) -> HarmonicFit:
        """The sine of a frequency that fits a channel best. frequency: in radians per unit of time, as 2*pi/period."""
        return HarmonicFit(**self._computed(self._core.harmonic, checked.text(channel, "channel"),
                                            checked.number(frequency, "frequency", above=0)))

    def write(self, path: Any, *, channels: Any = ()) -> None:
        """Writes the record, or these channels: HDF5 where the name ends in .h5 or .hdf5, otherwise text with commas, whose
        numbers are read back exactly. An existing file is replaced, but for the one that the record comes from."""
        names = checked.names(channels, "channels")
        with Replacement(path, self._inputs) as temporary:
            self._computed(self._core.write, temporary, names)

    def _written(self, folder: str) -> List[str]:
        self._computed(self._core.write, os.path.join(folder, "record.h5"), [])
        return ["record.h5"]

    def to_pandas(self) -> Any:
        """The samples as a pandas DataFrame."""
        return self.samples.to_pandas()

    def to_xarray(self) -> Any:
        """The samples as an xarray Dataset along the time."""
        time = self._core.time[0]
        data = self.samples.to_xarray()
        return data.set_coords(time).swap_dims(row=time)

    def __repr__(self) -> str:
        channels = ", ".join(f"{name} [{unit}]" if unit else name for name, unit in self.units.items())
        return f"<MeasuredRecord {self.name}: {channels}>"


def _record_again(name: str, time: Tuple[str, str], times: Any, channels: List[Tuple[str, str]], values: List[Any],
                  inputs: List[Tuple[str, str]], remarks: List[str]) -> MeasuredRecord:
    record = MeasuredRecord.__new__(MeasuredRecord)
    record._take(_graze.Record.of_arrays(name, time, times, channels, values), inputs, remarks)
    return record


class MeasuredRecords(_RecordTables, Sequence):  # type: ignore[type-arg]
    """Several records, as of a sweep: a sequence of MeasuredRecord, with tables and pictures of all together."""

    def __init__(self, records: Iterable[MeasuredRecord]) -> None:
        self._records = tuple(records)
        for one in self._records:
            if not isinstance(one, MeasuredRecord):
                raise InputError(f"a {type(one).__name__} is no MeasuredRecord", "read records by graze.read_record")
        if not self._records:
            raise InputError("there are no records", "give one or more")
        self._cores = [one._core for one in self._records]

    def _tell_remarks(self) -> None:
        for one in self._records:
            one._tell_remarks()

    def _bytes(self) -> int:
        return sum(one._bytes() for one in self._records)

    def __reduce__(self) -> Tuple[Any, ...]:
        return MeasuredRecords, (self._records,)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, slice):
            return MeasuredRecords(self._records[index])
        return self._records[index]

    def __len__(self) -> int:
        return len(self._records)

    def _written(self, folder: str) -> List[str]:
        names = [f"record{number}.h5" for number in range(1, len(self) + 1)]
        for one, name in zip(self._records, names):
            one._computed(one._core.write, os.path.join(folder, name), [])
        return names

    def processed(self, **given: Any) -> MeasuredRecords:
        """Each record processed in the same way: see `MeasuredRecord.processed`."""
        return MeasuredRecords(one.processed(**given) for one in self._records)

    def __repr__(self) -> str:
        return f"<MeasuredRecords: {len(self)} records, {', '.join(self._records[0].channels)}>"


def _array(values: Any, name: str) -> Any:
    import numpy

    try:
        return numpy.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} are no numbers", "give an array of numbers") from None


def read_record(path: Any, *more: Any, columns: Optional[str] = None, group: Optional[str] = None,
                skip: Optional[int] = None, names_line: Optional[int] = None, units_line: Optional[int] = None,
                **processing: Any) -> Any:
    """Opens a record: text or HDF5, of any length (docs/records.md says what can be read).

    columns: names and units of the columns of a text without a first line that says it: "t [s], V [V]". skip: lines to
        pass over at its beginning. names_line, units_line: lines with names and units, counted from 1. group: of HDF5,
        whose datasets are the channels.
    Other arguments process the record: see `MeasuredRecord.processed`.

    Returns a MeasuredRecord; of several paths, MeasuredRecords. Raises InputError, with file, line and column, for what
    is no record: here for its beginning, and otherwise where it is read; a warning tells what is left out.

        run = graze.read_record("run.csv", derivative="q")
        run.sections("V", phases=[0, 0.25]).to_pandas()
    """
    for name in processing:
        if name not in PROCESSING:
            raise TypeError(f"read_record() has no argument {name!r}; it has {', '.join((*READING, *PROCESSING))}")
    layout: Dict[str, Union[str, int]] = {}
    for name, text in (("columns", columns), ("group", group)):
        if text is not None:
            layout[name] = checked.text(text, name)
    for name, number, least in (("skip", skip, 0), ("names_line", names_line, 1), ("units_line", units_line, 1)):
        if number is not None:
            layout[name] = checked.whole(number, name, least, 1_000_000_000)
    words = processing_words(processing)
    records = []
    for one in (path, *more):
        file = checked.path_of(one, "a record")
        core = _graze.Record.opened(file, layout)
        records.append(MeasuredRecord._of(core.processed(words) if words else core, [("the record", file)]))
    return records[0] if not more else MeasuredRecords(records)
