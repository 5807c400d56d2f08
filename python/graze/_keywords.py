"""Keyword arguments of runs, written as the text of a study. So runs have the same keys, defaults, checks and messages
wherever they are asked for."""

from __future__ import annotations

import re
from functools import lru_cache

from . import _graze
from ._errors import Error, InputError, StudyError, as_kind

_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")


def toml_text(text: str) -> str:
    """A string of TOML."""
    escaped = "".join(
        {"\\": "\\\\", '"': '\\"'}.get(c, c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}") for c in text
    )
    return f'"{escaped}"'


def toml_key(name: str) -> str:
    return name if _BARE.match(name) else toml_text(name)


def toml_value(value, path: str) -> str:
    """A value of Python as one of TOML, in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return toml_text(value)
    if isinstance(value, int):
        if not -(2**63) <= value < 2**63:
            raise StudyError(f"{path} is {value}", "give a smaller number")
        return str(value)
    if isinstance(value, float):
        text = repr(value)
        return text if any(c in text for c in ".en") else text + ".0"
    if isinstance(value, _graze.Expression):
        return toml_text(str(value))
    if isinstance(value, dict):
        items = [f"{toml_key(_name(key, path))} = {toml_value(item, f'{path}.{key}')}" for key, item in value.items()
                 if item is not None]
        return "{ " + ", ".join(items) + " }" if items else "{}"
    if hasattr(value, "tolist"):  # numpy's numbers and arrays
        return toml_value(value.tolist(), path)
    if isinstance(value, (list, tuple, set, range)):
        return "[" + ", ".join(toml_value(item, f"{path}[{i}]") for i, item in enumerate(value)) + "]"
    if hasattr(value, "__fspath__"):
        return toml_text(str(value))
    raise StudyError(f"{path} is of type {type(value).__name__}, which no key takes",
                     "give a number, a text, a list or a dict")


def _name(key, path: str) -> str:
    if not isinstance(key, str):
        raise StudyError(f"{path} has the key {key!r}, which is no text", "name keys by texts")
    return key


@lru_cache(maxsize=None)
def keys_of(kind: str) -> dict:
    """The keys that runs of a kind have, in their order: name -> description."""
    return {key["name"]: key for key in _graze.study_keys(kind)}


def variation(value, path: str):
    """What `vary` says of one parameter or state: a dict as in studies, (from, to, points), or the values themselves."""
    if isinstance(value, tuple):
        if len(value) != 3:
            raise StudyError(f"{path} has {len(value)} items", "give (from, to, points), a list of values, or a dict")
        return {"from": value[0], "to": value[1], "points": value[2]}
    return value


class RunText:
    """The text of one run in a study, and which key each of its lines is about."""

    def __init__(self, name: str, kind: str, keys: dict):
        self.given = dict(keys)
        self.name = name
        lines = [f"[runs.{toml_key(name)}]", f'kind = "{kind}"']
        self.keys = [None, None]
        for key, value in keys.items():
            if value is None:
                continue
            if key == "vary" and isinstance(value, dict):
                value = {one: variation(item, f"vary.{one}") for one, item in value.items()}
            lines.append(f"{toml_key(_name(key, 'the call'))} = {toml_value(value, key)}")
            self.keys.append(key)
        self.text = "\n".join(lines) + "\n"

    def lines(self) -> int:
        return len(self.keys)


class StudyText:
    """Runs of one study, as text; mistakes in it are told as those of a call."""

    FILE = "study.toml"

    def __init__(self, name: str, runs):
        self.runs = list(runs)
        head = f"name = {toml_text(name)}\n\n"
        self.text = head + "\n".join(run.text for run in self.runs)
        self._lines = [None, None]
        for run in self.runs:
            self._lines += [(run, key) for key in run.keys] + [None]

    def told(self, error: Error, called: str) -> Error:
        """An error with the place in the call instead of that in the text."""
        result = as_kind(error, StudyError) if isinstance(error, InputError) else error
        for one in result.all:
            if one.file != self.FILE:
                continue
            key = None
            if 0 < one.line <= len(self._lines) and self._lines[one.line - 1]:
                run, key = self._lines[one.line - 1]
                for attribute in ("problem", "remedy"):
                    text = getattr(one, attribute).replace(f"runs.{run.name}.", "").replace(f"runs.{run.name}", called)
                    setattr(one, attribute, text)
            one.file = f"{called}, {key}" if key else called
            one.line = one.column = 0
        return result
