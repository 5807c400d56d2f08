"""Keyword arguments of runs, written as the text of a study. So runs have the same keys, defaults, checks and messages
wherever they are asked for."""

from __future__ import annotations

import os
import re
from functools import lru_cache
from typing import Any, Callable, Dict, Iterable, List, Optional, Tuple, TypeVar

from . import _graze
from ._errors import Error, InputError, StudyError, as_kind, relocated
from ._expressions import NOT_PLAIN, is_plain
from ._progress import interruptible

Function = TypeVar("Function", bound=Callable[..., Any])

_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")
_DEEPEST = 20  # tables within tables


def toml_text(text: str) -> str:
    """A string of TOML."""
    escaped = "".join(
        {"\\": "\\\\", '"': '\\"'}.get(c, c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}") for c in text
    )
    return f'"{escaped}"'


def toml_key(name: str) -> str:
    return name if _BARE.match(name) else toml_text(name)


def toml_value(value: Any, path: str, depth: int = 0) -> str:
    """A value of Python as one of TOML, in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return toml_text(_letters(value, path))
    if isinstance(value, int):
        if not -(2**63) <= value < 2**63:
            raise StudyError(f"{path} is {value}", "give a smaller number")
        return str(value)
    if isinstance(value, float):
        text = repr(float(value))  # numpy's numbers show their type
        return text if any(c in text for c in ".en") else text + ".0"
    if isinstance(value, _graze.Expression):
        return toml_text(str(value))
    if depth > _DEEPEST:
        raise StudyError(f"{path} is nested too deeply", "give a number, a text, a list or a dict")
    if hasattr(value, "items"):
        items = [f"{toml_key(_name(key, path))} = {toml_value(item, f'{path}.{key}', depth + 1)}"
                 for key, item in value.items() if item is not None]
        return "{ " + ", ".join(items) + " }" if items else "{}"
    if hasattr(value, "tolist"):  # numpy's numbers and arrays
        return toml_value(value.tolist(), path, depth + 1)
    if isinstance(value, (list, tuple, set, frozenset, range)):
        return "[" + ", ".join(toml_value(item, f"{path}[{i}]", depth + 1) for i, item in enumerate(value)) + "]"
    if hasattr(value, "__fspath__"):
        return toml_text(_letters(os.fsdecode(value), path))
    raise StudyError(f"{path} is of type {type(value).__name__}, which no key takes",
                     "give a number, a text, a list or a dict")


def _letters(text: str, path: str) -> str:
    if not is_plain(text):
        raise StudyError(f"{path} {NOT_PLAIN[0]}", NOT_PLAIN[1])
    return text


def _name(key: Any, path: str) -> str:
    if not isinstance(key, str):
        raise StudyError(f"{path} has the key {key!r}, which is no text", "name keys by texts")
    return _letters(key, path)


@lru_cache(maxsize=None)
def keys_of(kind: str) -> Dict[str, Any]:
    """The keys that runs of a kind have, in their order: name -> description."""
    return {key["name"]: key for key in _graze.study_keys(kind)}


def variation(value: Any, path: str) -> Any:
    """What `vary` says of one parameter or state: a dict as in studies, (from, to, points), or the values themselves."""
    if isinstance(value, tuple):
        if len(value) != 3:
            raise StudyError(f"{path} has {len(value)} items", "give (from, to, points), a list of values, or a dict")
        points = value[2]
        if isinstance(points, float) and points.is_integer():
            points = int(points)
        return {"from": value[0], "to": value[1], "points": points}
    return value


class RunText:
    """The text of one run in a study, and which key each of its lines is about.

    keys: as the study has them; runs, models and files are named by texts. folder: where files are looked for; an
    OwnFolder lives as long as the text.
    """

    def __init__(self, name: str, kind: str, keys: Dict[str, Any], folder: Any = "") -> None:
        self.name = name
        self.kind = kind
        self.folder = folder
        self.given = {key: value for key, value in keys.items() if value is not None}
        lines = [f"[runs.{toml_key(name)}]", f'kind = "{kind}"']
        self.keys: List[Optional[str]] = [None, None]
        for key, value in self.given.items():
            if key == "vary" and hasattr(value, "items"):
                value = {one: variation(item, f"vary.{one}") for one, item in value.items()}
            lines.append(f"{toml_key(_name(key, 'the call'))} = {toml_value(value, key)}")
            self.keys.append(key)
        self.text = "\n".join(lines) + "\n"

    def needs(self) -> List[str]:
        """Names of the runs that this one goes on from, or whose results it uses."""
        start: Any = self.given.get("start")
        names = [start["run"]] if hasattr(start, "items") and "run" in start else []
        for key in ("parameters", "records"):
            some = self.given.get(key, [])
            names += [some] if isinstance(some, str) else list(some)
        return names

    def renamed(self, name: str, runs: Dict[str, Any], model: Any) -> RunText:
        """The same run under another name, with other names of the runs that it needs, and of its model."""
        keys = dict(self.given)
        if "model" in keys:
            keys["model"] = model
        if hasattr(keys.get("start"), "items") and "run" in keys["start"]:
            keys["start"] = {**keys["start"], "run": runs[keys["start"]["run"]]}
        for key in ("parameters", "records"):
            if key in keys:
                keys[key] = runs[keys[key]] if isinstance(keys[key], str) else [runs[one] for one in keys[key]]
        return RunText(name, self.kind, keys, self.folder)

    def __reduce__(self) -> Tuple[Any, ...]:
        return RunText, (self.name, self.kind, self.given, self.folder)


def study_text(name: str, runs: Iterable[RunText]) -> str:
    """The text of a study of these runs."""
    return f"name = {toml_text(name)}\n\n" + "\n".join(run.text for run in runs)


# What messages of the library call things that a caller in Python knows by other names.
_WORDS = (
    ("relative to the study", "relative to the working folder"),
    ("the study's folder", "the working folder"),
    ("the study has no run ", "there is no run "),
    ("must be a table", "must be a dict"),
    (", not a table", ", not a dict"),
)


_TABLE = re.compile(r"(?:\b([a-z_]+) = )?(\{ (?:[^{}]|\{[^{}]*\})* \})")  # as a file has it, with tables in it


class CallText:
    """One run as the text of a study, for which mistakes are told as those of a call."""

    def __init__(self, run: RunText, called: str) -> None:
        self.run = run
        self.called = called
        self.file = os.path.join(run.folder, called)  # files are looked for beside it
        self.text = study_text("python", [run])
        self._keys = [None, None, *run.keys]
        self._place = re.compile(re.escape(self.file) + r"(?::(\d+))?(?::\d+)?: ")

    def _where(self, line: int) -> str:
        key = self._keys[line - 1] if 0 < line <= len(self._keys) else None
        return f"{self.called}, {key}" if key else self.called

    def words(self, text: str) -> str:
        """A text of the library in the words of the call."""
        text = self._place.sub(lambda found: self._where(int(found[1] or 0)) + ": ", text)
        text = text.replace(f"runs.{self.run.name}.", "").replace(f"runs.{self.run.name}", self.called)
        for words, others in _WORDS:
            text = text.replace(words, others)
        text = "give a dict" if text == "give a table" else text
        return _TABLE.sub(lambda found: (f"{found[1]}=" if found[1] else "") + _python_form(found[2]), text)

    def told(self, error: Error) -> Error:
        """An error with the place in the call instead of that in the text."""
        result: Error = relocated(as_kind(error, StudyError) if isinstance(error, InputError) else error,
                                  lambda one: self._where(one.line) if one.file == self.file else None, self.words)
        return result


_TYPES = {"number": ("float", "a number"), "whole number": ("int", "a whole number"),
          "true or false": ("bool", "True or False"), "text": ("str", "a text"), "one of": ("str", "one of")}
_FORMS = {'"RUN" or ["RUN"]': "a run or a list of runs", "{ run, at, direction, point, onto }": "a point, or a run",
          "{ V = { from, to, step } }": '{"V": (from, to, points)}, or lists of values, or dicts as in studies'}
_TRUTHS = {"true": "True", "false": "False"}


def _python_form(form: str) -> str:
    """How a value is written in Python, of the form that it has in a study."""
    form = re.sub(r"([{,] )(\w+) = ", r'\1"\2": ', form)
    form = form.replace("[..]", "[...]")
    form = re.sub(r"\b(true|false)\b", lambda word: _TRUTHS[word[1]], form)
    return form.replace("{ ", "{").replace(" }", "}")


def _described(key: Dict[str, Any]) -> str:
    words = _FORMS.get(key["type"]) or _TYPES.get(key["type"], ("", _python_form(key["type"])))[1]
    if key["words"]:
        words += " " + ", ".join(repr(one) for one in key["words"])
    least, most = key["least"], key["most"]
    start = "from" if key["includes_least"] else "above"
    if least is not None and most is not None and most < 1e15:
        words += f" {start} {least:.15g} to {most:.15g}"
    elif least is not None:
        words += f" {start} {least:.15g}"
    standard = _TRUTHS.get(key["standard"], key["standard"])
    meaning = re.sub(r"`(true|false)`", lambda word: _TRUTHS[word[1]], key["meaning"])
    return f"{words}{f' ({standard})' if standard else ''}: {meaning}."


def _wrapped(text: str, indent: str) -> str:
    lines, line = [], indent
    for word in text.split():
        if len(line) + len(word) >= 112 and line.strip():
            lines.append(line)
            line = indent + "    "
        line += word if line.endswith(" ") or not line else " " + word
    return "\n".join([*lines, line])


def _argument(name: str) -> str:
    return "from_" if name == "from" else name


class RunFunction:
    """A function, or a method, that carries out a run and takes its keys as keyword arguments. Its signature and its
    documentation list these keys; both are made when somebody asks for them."""

    __qualname__: str

    def __init__(self, function: Callable[..., Any], kind: str, hidden: Iterable[str] = ()) -> None:
        for name in ("__module__", "__name__", "__qualname__"):
            setattr(self, name, getattr(function, name))
        self.__wrapped__ = function
        self._kind = kind
        self._hidden = {"kind", "model", *hidden}
        self._text = function.__doc__ or ""

    def __call__(self, *arguments: Any, **keys: Any) -> Any:
        with interruptible():
            return self.__wrapped__(*arguments, **keys)

    def __get__(self, instance: Any, owner: Any = None) -> Any:
        if instance is None:
            return self
        from types import MethodType

        return MethodType(self, instance)

    def __reduce__(self) -> str:
        return self.__qualname__

    def _keys(self) -> List[Dict[str, Any]]:
        return [key for name, key in keys_of(self._kind).items() if name not in self._hidden]

    @property
    def __doc__(self) -> str:  # type: ignore[override]
        indent = " " * 4
        if "." in self.__qualname__:
            indent *= 2
        lines = [_wrapped(f"{_argument(key['name'])}: {_described(key)}", indent) for key in self._keys()]
        return "\n".join([self._text.rstrip(), "", f"{indent}Keys of runs of kind {self._kind!r}:", "", *lines, ""])

    @property
    def __signature__(self) -> Any:
        import inspect

        def default(key: Any) -> Any:
            kind = {"number": float, "whole number": int}.get(key["type"])
            try:
                return kind(key["standard"]) if kind else {"true": True, "false": False}.get(key["standard"])
            except ValueError:
                return key["standard"] if key["words"] and key["standard"] in key["words"] else None

        own = inspect.signature(self.__wrapped__)
        known = list(own.parameters.values())
        rest = [one for one in known if one.kind is inspect.Parameter.VAR_KEYWORD]
        shown = [one for one in known if one not in rest]
        names = {one.name for one in shown}
        for key in self._keys():
            name = _argument(key["name"])
            if name not in names:
                shown.append(inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default(key),
                                               annotation=_TYPES.get(key["type"], (inspect.Parameter.empty,))[0]))
        if "along" in keys_of(self._kind):  # parameters that are followed may be keyword arguments themselves
            shown.append(inspect.Parameter("followed", inspect.Parameter.VAR_KEYWORD))
        return own.replace(parameters=shown)

    def __repr__(self) -> str:
        return f"<function {self.__module__}.{self.__qualname__}>"


def takes_keys_of(kind: str, *hidden: str) -> Callable[[Function], Function]:
    """Marks a function as one that takes the keys of runs of a kind, but for those that are hidden."""
    def marked(function: Any) -> Any:
        return RunFunction(function, kind, hidden)

    return marked
