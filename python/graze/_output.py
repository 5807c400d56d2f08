"""Files that are written, as the program writes them: whole or not at all, and never over an input or a database."""

from __future__ import annotations

import os
import secrets
import shutil
import tempfile
import weakref
from contextlib import contextmanager
from typing import Any, Dict, Iterable, Iterator, Tuple, Union

from ._arguments import path_of
from ._errors import FileError, InputError

Path = Union[str, "os.PathLike[str]"]

_DATABASE = b"SQLite format 3\0"


def _is_database(path: str) -> bool:
    try:
        with open(path, "rb") as file:
            return file.read(len(_DATABASE)) == _DATABASE
    except OSError:
        return False


def _belongs_to_database(path: str) -> bool:
    endings = ("", "-wal", "-shm", "-journal", ".lock")
    return any(path.endswith(end) and os.path.isfile(path[: len(path) - len(end)])
               and _is_database(path[: len(path) - len(end)]) for end in endings)


Inputs = Iterable[Tuple[str, str]]
"""What each input is, and its path."""


def require_no_input(path: str, inputs: Inputs) -> None:
    """inputs: pairs of what a file is, and its path."""
    for what, known in inputs:
        try:
            same = bool(known) and os.path.isfile(known) and os.path.samefile(path, known)
        except OSError:
            continue
        if same:
            raise InputError(f"'{path}' is the file of {what} too", "choose another name")


def _told(path: str, error: OSError) -> FileError:
    return FileError(f"'{path}' cannot be written: {error.strerror or error}",
                     "choose another place, or change the permissions")


@contextmanager
def writing(path: Any) -> Iterator[None]:
    """Errors of the system while something is written, as those of the package."""
    try:
        yield
    except FileError:
        raise
    except OSError as error:
        raise _told(error.filename or os.fspath(path), error) from None


class Replacement:
    """A file that is written under another name beside it, `with Replacement(path) as temporary`, and takes the place of
    what is there when all went well."""

    def __init__(self, path: Any, inputs: Inputs = ()) -> None:
        self.path = path_of(path, "a file")
        self.target = os.path.realpath(self.path)  # the target of a link is replaced, not the link
        if os.path.isdir(self.target):
            raise FileError(f"'{self.path}' cannot be written: it is a folder", "name a file in it")
        require_no_input(self.path, inputs)
        if _belongs_to_database(self.target):
            raise FileError(f"'{self.path}' is a result file or another database, which is not overwritten",
                            "choose another file")
        if os.path.exists(self.target) and not os.access(self.target, os.W_OK):
            raise FileError(f"'{self.path}' cannot be written: it is protected", "choose another file")
        self._direct = os.path.exists(self.target) and not os.path.isfile(self.target)  # as /dev/null

    def __enter__(self) -> str:
        if self._direct:
            self.temporary: str = self.target
            return self.temporary
        stem, ending = os.path.splitext(os.path.basename(self.target))
        try:
            handle, self.temporary = tempfile.mkstemp(ending, f".{stem[:100]}.", os.path.dirname(self.target))
            if os.path.exists(self.target):
                os.fchmod(handle, os.stat(self.target).st_mode & 0o777)
            else:
                mask = os.umask(0)
                os.umask(mask)
                os.fchmod(handle, 0o666 & ~mask)
            os.close(handle)
        except OSError as error:
            raise _told(self.path, error) from None
        return self.temporary

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        try:
            if self._direct:
                pass
            elif kind is None:
                os.replace(self.temporary, self.target)
            else:
                os.unlink(self.temporary)
        except OSError as failure:
            if kind is None:
                raise _told(self.path, failure) from None
        if isinstance(error, OSError) and not isinstance(error, FileError):
            raise _told(self.path, error) from None


def write_file(path: Any, contents: Union[str, bytes], inputs: Inputs = ()) -> None:
    """Writes a text or bytes.

    inputs: pairs of what a file is, and its path: files that are not replaced.
    """
    with Replacement(path, inputs) as temporary:
        with open(temporary, "wb") as file:
            file.write(contents if isinstance(contents, bytes) else contents.encode())


def made_folder(folder: Any) -> str:
    """Makes a folder for results, if it is missing. Returns its path."""
    path = path_of(folder, "a folder")
    with writing(path):
        os.makedirs(path, exist_ok=True)
    return path


def empty_folder(folder: Any) -> str:
    """The same for a folder that has nothing in it. FileError if it has something in it already."""
    path = made_folder(folder)
    with writing(path):
        occupied = bool(os.listdir(path))
    if occupied:
        raise FileError(f"there is something in the folder '{path}' already", "choose another one, or empty it")
    return path


def _remove(folder: str, owner: int) -> None:
    if os.getpid() == owner:  # not in a process that was forked
        shutil.rmtree(folder, ignore_errors=True)


class OwnFolder:
    """A temporary folder, which is made when it is needed first, and lives as long as this object. Pickles have its files."""

    def __init__(self) -> None:
        self._path = ""

    @property
    def path(self) -> str:
        if not self._path:
            with writing("a temporary folder"):
                path = os.path.join(tempfile.gettempdir(), f"graze-{secrets.token_hex(8)}")
                # Before the folder is there, so that an interruption leaves none.
                removal = weakref.finalize(self, _remove, path, os.getpid())
                try:
                    os.mkdir(path, 0o700)
                except OSError:
                    removal.detach()  # what is there is another's
                    raise
            self._path = path
        return self._path

    def __fspath__(self) -> str:
        return self.path

    def __reduce__(self) -> Tuple[Any, ...]:
        files: Dict[str, bytes] = {}
        if self._path:
            for name in os.listdir(self._path):
                with open(os.path.join(self._path, name), "rb") as file:
                    files[name] = file.read()
        return _restored_folder, (files,)


def _restored_folder(files: Dict[str, bytes]) -> OwnFolder:
    folder = OwnFolder()
    for name, contents in files.items():
        with open(os.path.join(folder.path, name), "wb") as file:
            file.write(contents)
    return folder
