"""Texts of design and experiment files, of which the keys of a call change some."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Callable, Dict, List, Optional, Tuple

from . import _graze
from ._arguments import path_of, text as checked_text
from ._errors import Error, FileError, InputError, relocated
from ._keywords import toml_key, toml_value
from ._model import Model
from ._output import OwnFolder


class DesignText:
    """The text of a design file, from a shipped design or a file, and what is changed of it."""

    _what = "design"
    _remedy = "give the name of a shipped design (graze.designs() lists them), or a file"
    _shipped = True  # a word without an ending names a shipped one

    def __init__(self, design: Any, text: Any, keys: Dict[str, Any], called: str) -> None:
        """keys: of design files; dicts in them change what they name, None takes a key away."""
        self.called = called
        self.folder = OwnFolder()
        self._keys: Optional[List[str]] = None  # of each line; None: the text is that of a file
        if design is not None and text is not None:
            raise InputError(f"{called} was given a design and a text", "give one of them")
        self.path = ""  # of the user's file
        if text is not None:
            self.file, self.text = "design.toml", checked_text(text, "text")
        elif design is not None:
            self.file, self.text = self._read(design)
        else:
            self.file, self.text = "design.toml", ""
        if keys or (design is None and text is None):
            self._change({name[:-1] if name in ("yield_", "set_") else name: value for name, value in keys.items()})

    def _read(self, design: Any) -> Tuple[str, str]:
        """The place that mistakes are told with, and the text."""
        name = path_of(design, f"the {self._what}", self.called, self._remedy)
        if self._shipped and "/" not in name and not name.endswith(".toml"):
            return name, str(_graze.shipped_design_text(name))
        try:
            with open(name, encoding="utf-8") as file:
                self.path = name
                return name, file.read()
        except OSError as error:
            raise FileError(f"the {self._what} '{name}' cannot be read: {error.strerror}", self._remedy) from None
        except UnicodeDecodeError:
            raise FileError(f"the {self._what} '{name}' is no text in UTF-8", "name another file") from None

    def _change(self, keys: Dict[str, Any]) -> None:
        import tomllib

        try:
            given = tomllib.loads(self.text)
        except tomllib.TOMLDecodeError:
            return  # the library's reader says what is wrong, and where
        lines: List[str] = []
        names: List[str] = []
        for name, value in _merged(given, keys).items():
            if isinstance(value, Model):
                value = self._model_file(value)
            try:
                lines.append(f"{toml_key(name)} = {toml_value(value, name)}")
            except InputError as error:
                raise InputError(error.problem, error.remedy, f"{self.called}, {name}") from None
            names.append(name)
        self._keys = names
        self.text = "\n".join(lines) + "\n"

    def _model_file(self, model: Model) -> str:
        path = os.path.join(self.folder.path, f"{model.name or 'model'}.toml")
        model.save(path)
        return path

    def told(self, error: Error) -> Error:
        """An error with the place in the call instead of that in the text."""
        keys = self._keys
        if keys is None:
            return error

        def place_of(one: Error) -> Optional[str]:
            if one.file != self.file:
                return None
            return f"{self.called}, {keys[one.line - 1]}" if 0 < one.line <= len(keys) else self.called

        told: Error = relocated(error, place_of)
        return told

    def read(self, reader: Callable[[str, str], Any]) -> Any:
        """What a reader of the library makes of the text."""
        try:
            return reader(self.text, self.file)
        except InputError as error:
            raise self.told(error) from None


class ExperimentText(DesignText):
    """The text of an experiment file, and what is changed of it."""

    _what = "experiment"
    _remedy = "give the file of an experiment, or its keys"
    _shipped = False


def _merged(given: Any, changes: Any) -> Dict[str, Any]:
    result = dict(given)
    for name, value in changes.items():
        if value is None:
            result.pop(name, None)
        elif isinstance(value, Mapping) and isinstance(result.get(name), dict):
            result[name] = _merged(result[name], value)
        else:
            result[name] = value
    return result
