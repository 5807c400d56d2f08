"""The type stub of the compiled part, python/graze/_graze.pyi, from the signatures that the module itself tells.

usage: PYTHONPATH=build/release/python python3 tests/python/compiled_stub.py [FILE]: writes it (to standard output)
"""

import inspect
import re
import sys

from graze import _graze

HEAD = '''"""The compiled part of graze: internal. This file is made by tests/python/compiled_stub.py."""

from typing import Any, Callable, Dict, Iterator, List, Optional, Tuple, Union

import numpy

'''
# How pybind11 writes types, and what they are in a stub.
TYPES = [
    (r"(?:\w+::)*\(anonymous namespace\)::\w+", "Any"),
    (r"numpy\.ndarray\[[^\]]*\]", "numpy.ndarray[Any, Any]"),
    (r"\[\d+\]", ""),
    (r"graze\._graze\.", ""),
    (r"\b(?:graze::)?[A-Za-z_]\w*(?:::\w+)+(?:<[^,]*>)?", "Any"),
    (r"<[^<>]* object at 0x[0-9a-f]+>", "..."),
    (r"\bobject\b|\bhandle\b", "Any"),
    (r"\bfunction\b", "Callable[..., Any]"),
    (r"\biterable\b", "Any"),
    (r"\bIterator\b(?!\[)", "Iterator[Any]"),
    (r"\bcapsule\b", "Any"),
    (r"\blist\b(?!\[)", "List[Any]"),
    (r"\bdict\b(?!\[)", "Dict[Any, Any]"),
    (r"\btuple\b(?!\[)", "Tuple[Any, ...]"),
]
LINE = re.compile(r"^(?:\d+\. )?(\w+)\((.*)\) -> (.+)$")


def plain(text: str) -> str:
    for pattern, meaning in TYPES:
        text = re.sub(pattern, meaning, text)
    return re.sub(r": (\w+) = None", r": Optional[\1] = None", text)


def signatures(function) -> list:
    """(arguments, result) of each overload that a compiled function has."""
    found = [LINE.match(line) for line in (function.__doc__ or "").splitlines()]
    return [(plain(one[2]), plain(one[3])) for one in found if one and "*args, **kwargs" not in one[0]]


def lines_of_function(name: str, function, indent: str, decorator: str = "") -> list:
    known = signatures(function)
    if not known:
        arguments = "*arguments: Any, **words: Any"
        known = [(f"self, {arguments}" if indent and decorator != "@staticmethod" else arguments, "Any")]
    if len(known) > 1:  # overloads have arguments of several types
        first = "self, " if indent and decorator != "@staticmethod" else ""
        results = {result for _, result in known}
        known = [(f"{first}*arguments: Any", results.pop() if len(results) == 1 else "Any")]
    arguments, result = known[0]
    arguments = re.sub(r"^self: \w+", "self", arguments)
    if indent and decorator != "@staticmethod" and not arguments.startswith("self"):
        # operators: pybind11 calls their arguments arg0, arg1
        arguments = re.sub(r"^arg0: \w+", "self", arguments)
    if name == "__init__":
        result = "None"
    lines = [f"{indent}{decorator}"] if decorator else []
    return [*lines, f"{indent}def {name}({arguments}) -> {result}: ..."]


LEFT_OUT = {"__new__", "__reduce__", "__doc__", "__module__", "__dict__", "__weakref__", "__annotations__"}


def lines_of_class(kind) -> list:
    lines = [f"class {kind.__name__}:"]
    for name, member in sorted(vars(kind).items()):
        if name in LEFT_OUT or name.startswith("_pybind11"):
            continue
        if name == "__hash__" and member is None:
            lines.append("    __hash__: None  # type: ignore[assignment]")
        elif isinstance(member, property):
            result = re.search(r"-> (.+)$", (member.fget.__doc__ or "").split("\n")[0])
            lines += ["    @property", f"    def {name}(self) -> {plain(result[1]) if result else 'Any'}: ..."]
            if member.fset:
                lines += [f"    @{name}.setter", f"    def {name}(self, value: Any) -> None: ..."]
        elif isinstance(member, staticmethod):
            lines += lines_of_function(name, member.__func__, "    ", "@staticmethod")
        elif inspect.isfunction(member):  # added by the package: python/graze/_expressions.py has its annotations
            lines.append(f"    def {name}(self, *arguments: Any, **words: Any) -> Any: ...")
        elif callable(member) or inspect.ismethoddescriptor(member):
            lines += lines_of_function(name, member, "    ")
        else:
            lines.append(f"    {name}: Any")
    return lines if len(lines) > 1 else [*lines, "    ..."]


def stub() -> str:
    parts = []
    for name, member in sorted(vars(_graze).items()):
        if name.startswith("__"):
            continue
        if inspect.isclass(member):
            parts.append("\n".join(lines_of_class(member)))
        elif callable(member):
            parts.append("\n".join(lines_of_function(name, member, "")))
        else:
            parts.append(f"{name}: {type(member).__name__}")
    return HEAD + "\n\n".join(parts) + "\n"


if __name__ == "__main__":
    text = stub()
    if len(sys.argv) > 1:
        with open(sys.argv[1], "w", encoding="utf-8") as file:
            file.write(text)
    else:
        print(text, end="")
