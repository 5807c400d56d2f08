"""Files that are read as texts."""

from __future__ import annotations

import os
import stat

from ._errors import FileError

LONGEST = 16 << 20  # bytes of a text, as in the library; a longer file is a mistake or an attack


def _kind(mode: int) -> str:
    return "directory" if stat.S_ISDIR(mode) else "pipe" if stat.S_ISFIFO(mode) else "device"


def read_text(path: str, what: str, remedy: str) -> str:
    """The text of a regular file, with the checks of the library: reading a device may never end, and reading a pipe may
    never begin. what: as "design", for messages."""
    try:
        # O_NONBLOCK: to open a pipe would otherwise wait for another process.
        handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOCTTY)
        try:
            mode = os.fstat(handle).st_mode
            if not stat.S_ISREG(mode):
                raise FileError(f"this is a {_kind(mode)}, no {what}", "give the name of a regular file", path)
            with open(handle, "rb", closefd=False) as file:
                contents = file.read(LONGEST + 1)
        finally:
            os.close(handle)
        if len(contents) > LONGEST:
            raise FileError(f"there are more than {LONGEST} bytes in this {what}", remedy, path)
        return contents.decode()
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"the {what} '{path}' cannot be read: {error.strerror}", remedy) from None
    except UnicodeDecodeError:
        raise FileError(f"the {what} '{path}' is no text in UTF-8", "name another file") from None
