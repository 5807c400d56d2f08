"""The process that makes a generator safe if the one that uses it is killed."""

from __future__ import annotations

import sys

from . import _graze
from ._design_text import DesignText
from ._errors import InstrumentError

_WATCH = "import sys; sys.path[:] = sys.argv[3:]; from graze._watchdog import watch; watch(*sys.argv[1:3])"


def watch(file: str, port: str) -> None:
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


class Watchdog:
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
