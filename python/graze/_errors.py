"""What the package raises. Each error says what is wrong and what to do, with the place where it is known."""

from __future__ import annotations

from typing import Any, Callable, List, Optional, Tuple


class Error(Exception):
    """Any error of the package.

    Attributes: `problem` (what is wrong), `remedy` (what to do; may be empty), `file`, `line` and `column` of the place
    (empty and 0 where they are not known; lines and columns count from 1), and `all`, the list of all mistakes where a
    text has several, of which this one is the first.
    """

    def __init__(self, problem: str, remedy: str = "", file: str = "", line: int = 0, column: int = 0) -> None:
        super().__init__(problem)
        self.problem = problem
        self.remedy = remedy
        self.file = file
        self.line = line
        self.column = column
        self.all: List[Error] = [self]

    @property
    def place(self) -> str:
        """`file:line:column`, without what is not known."""
        known = [str(number) for number in (self.line, self.column) if number]
        return ":".join([self.file, *known] if self.file else known)

    def __str__(self) -> str:
        lines = []
        for one in self.all if len(self.all) > 1 else [self]:
            text = f"{one.place}: {one.problem}" if one.place else one.problem
            lines.append(f"{text}; {one.remedy}" if one.remedy else text)
        return "\n".join(lines)

    def __reduce__(self) -> Tuple[Any, ...]:
        return _restored, (type(self), self.problem, self.remedy, self.file, self.line, self.column, self.all[1:])


def _restored(kind: type, problem: str, remedy: str, file: str, line: int, column: int, others: List[Error]) -> Error:
    error: Error = kind(problem, remedy, file, line, column)
    error.all += others
    return error


class InputError(Error, ValueError):
    """What was given cannot be used: a text, an argument, a record."""


class WrongType(InputError, TypeError):
    """An argument is of a type that cannot be used."""


class ModelError(InputError):
    """A model has a mistake."""


class StudyError(InputError):
    """A study, or what was asked of a run, has a mistake."""


class FileError(InputError, OSError):
    """A file cannot be opened, read or written, or somebody else uses it."""

    __str__ = Error.__str__  # OSError has one of its own


class _WithRun(Error):
    """An error that has what was computed, or recorded, until then."""

    run: Any = None

    def __reduce__(self) -> Tuple[Any, ...]:
        return (*super().__reduce__(), {"run": self.run})


class InstrumentError(_WithRun):
    """An instrument does not do what it should. `run` has the records that are there, where there are some."""


class OrderError(Error):
    """Something was asked of an object before what it needs."""


class InternalError(Error):
    """The library contradicts itself: please report it."""


class RunFailed(_WithRun):
    """A run has ended without a result, as when no periodic orbit was found. `run` has what was computed."""


class WorkersLost(_WithRun):
    """The executor that computes a run or a yield has lost its workers, or takes no work. `run` has what was computed; the
    `resume` of a run goes on, with another executor or without one."""


class Interrupted(KeyboardInterrupt):
    """Computing was interrupted, by Ctrl-C or by a function `progress` that returned False.

    Attributes: `run` has what was computed until then, a run (whose file can be continued), a motion or another result;
    None: nothing.
    `motion` is the same.
    """

    def __init__(self, run: Any = None) -> None:
        super().__init__("interrupted; the attribute `run` has what was computed" if run is not None else "interrupted")
        self.run = run

    @property
    def motion(self) -> Any:
        """What was computed until then, where that is a motion: the same as `run`."""
        return self.run

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (self.run,)


_KINDS = {"input": InputError, "file": FileError, "instrument": InstrumentError, "order": OrderError}


def made(kind: str, problem: str, remedy: str, file: str, line: int, column: int) -> Error:
    """Called by the compiled part for each error of the library."""
    return _KINDS.get(kind, InternalError)(problem, remedy, file, line, column)


def as_kind(error: InputError, kind: type) -> Error:
    """The same error as one of a narrower kind; files that cannot be read stay what they are."""
    if isinstance(error, FileError):
        return error
    result: Error = kind(error.problem, error.remedy, error.file, error.line, error.column)
    result.all += [as_kind(one, kind) if isinstance(one, InputError) else one for one in error.all[1:]]
    return result


def relocated(error: Any, place_of: Callable[[Error], Optional[str]], words: Callable[[str], str] = str) -> Any:
    """An error whose mistakes have another place, such as an argument of a call in place of a line of the text that was
    made of it. place_of: the place of a mistake; None: it stays as it is. words: other words for problems and remedies.
    Returns the error."""
    for one in error.all:
        one.problem, one.remedy = words(one.problem), words(one.remedy)
        place = place_of(one)
        if place is not None:
            one.file, one.line, one.column = place, 0, 0
    return error
