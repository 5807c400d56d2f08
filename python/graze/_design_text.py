"""Texts of design and experiment files, of which the keys of a call change some."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Callable, Dict, List, Optional, Tuple

from . import _graze
from ._arguments import path_of, text as checked_text
from ._errors import Error, InputError, relocated
from ._input import read_text
from ._keywords import toml_key, toml_value
from ._model import Model
from ._output import OwnFolder


class DesignText:
    """The text of a design file, from a shipped design or a file, and what is changed of it."""

    _what = "design"
    _remedy = "give the name of a shipped design (graze.designs() lists them), or a file"
    _shipped = True  # a word without an ending names a shipped one
    _parsed: Callable[[str, str], Any] = _graze.Design.parsed

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
        text = read_text(name, self._what, self._remedy)
        self.path = name
        return name, text

    def _change(self, keys: Dict[str, Any]) -> None:
        import tomllib

        try:
            given = tomllib.loads(self.text)
        except tomllib.TOMLDecodeError:
            return  # the library's reader says what is wrong, and where
        changed, asked = _merged(given, keys), _merged(given, keys, absent={})
        self.text, self._keys = self._text_of(changed)
        if asked != changed:
            self._require_known(*self._text_of(asked))

    def _text_of(self, keys: Dict[str, Any]) -> Tuple[str, List[str]]:
        """The text of a file with these keys, and the key of each of its lines."""
        lines: List[str] = []
        for name, value in keys.items():
            checked_text(name, self.called)
            if isinstance(value, Model):
                value = self._model_file(value)
            try:
                lines.append(f"{toml_key(name)} = {toml_value(value, name)}")
            except InputError as error:
                raise InputError(error.problem, error.remedy, f"{self.called}, {name}") from None
        return "\n".join(lines) + "\n", list(keys)

    def _require_known(self, text: str, keys: List[str]) -> None:
        """Refuses unknown keys of which a call says that they are not given (None): the library knows which there are.
        text: has empty tables in their places."""
        try:
            type(self)._parsed(text, self.file)
        except InputError as error:
            for one in error.all:
                if one.problem.startswith("unknown key") and 0 < one.line <= len(keys):
                    raise InputError(one.problem, one.remedy, f"{self.called}, {keys[one.line - 1]}") from None

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
    _parsed = _graze.Experiment.parsed


def _merged(given: Any, changes: Any, absent: Any = None) -> Dict[str, Any]:
    """absent: what stands for a key that is not given and that the changes take away; None: nothing."""
    result = dict(given)
    for name, value in changes.items():
        if value is None and name not in given and absent is not None:
            result[name] = absent
        elif value is None:
            result.pop(name, None)
        elif isinstance(value, Mapping):
            before = result.get(name)
            result[name] = _merged(before if isinstance(before, dict) else {}, value, absent)
        else:
            result[name] = value
    return result
