"""What records are asked: how they are processed, and what is computed from them, in the words of the compiled part."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Dict, Iterable, List, Optional, Tuple

from . import _arguments as checked
from ._errors import InputError

PROCESSING = ("scale", "from_", "to", "pass_", "stop", "every", "derivative", "half_width")
READING = ("columns", "group", "skip", "names_line", "units_line")


def _scales(scale: Any) -> List[Tuple[str, float, float, Optional[str]]]:
    if not isinstance(scale, Mapping):
        raise InputError(f"scale is {scale!r}", 'give a dict, as {"q": 2.011} or {"q": (2.011, 0.5, "mm")}')
    scales = []
    for channel, value in scale.items():
        what = f"scale of {channel}"
        parts = value if isinstance(value, (tuple, list)) else (value,)
        if not 1 <= len(parts) <= 3:
            raise InputError(f"{what} has {len(parts)} items", "give a factor, or (factor, offset, unit)")
        unit = checked.text(parts[2], f"unit in the {what}") if len(parts) == 3 and parts[2] is not None else None
        scales.append((checked.text(channel, "a channel of scale"), checked.number(parts[0], what),
                       checked.number(parts[1], what) if len(parts) > 1 else 0.0, unit))
    return scales


def processing_words(given: Dict[str, Any]) -> Dict[str, Any]:
    """Keyword arguments of processing, in the words of the compiled part."""
    words: Dict[str, Any] = {}
    for name, value in given.items():
        if value is None:
            continue
        if name == "scale":
            words["scale"] = _scales(value)
        elif name in ("from_", "to"):
            words[name.rstrip("_")] = checked.number(value, name)
        elif name in ("pass_", "stop"):
            words[name.rstrip("_")] = checked.number(value, name, above=0)
        elif name == "every":
            words["every"] = checked.whole(value, name, 1, 1_000_000)
        elif name == "half_width":
            words["half_width"] = checked.whole(value, name, 4, 100_000)
        else:
            words["derivative"] = checked.text(value, name)
    if "stop" in words and "pass" not in words:
        raise InputError("stop is given without pass_", "give pass_ too")
    if "half_width" in words and "derivative" not in words:
        raise InputError("half_width is given without derivative", "give derivative too")
    return words


def table_words(what: str, given: Dict[str, Any]) -> Dict[str, Any]:
    words: Dict[str, Any] = {}
    for name, value in given.items():
        if value is None:
            continue
        if name in ("channels", "negate"):
            words[name] = checked.names(value, name)
        elif name == "channel":
            words["channels"] = checked.names(value, name)
        elif name in ("reference", "displacement"):
            words[name] = checked.text(value, name)
        elif name == "level":
            words[name] = checked.number(value, name)
        elif name == "hysteresis":
            words[name] = checked.number(value, name, above=0)
        elif name == "least_jump":
            words[name] = checked.number(value, name, least=0)
        elif name == "phases":
            words[name] = [_phase(one) for one in (value if isinstance(value, Iterable) else [value])]
        elif name == "window":
            words[name] = checked.whole(value, name, 5, 100_000)
        elif name == "transition":
            words[name] = checked.whole(value, name, 0, 100_000)
        elif name == "part":
            words[name] = checked.whole(value, name, 8, 4_000_000)
        else:
            raise TypeError(f"the table {what!r} of records has no argument {name!r}")
    return words


def _phase(value: Any) -> float:
    phase = checked.number(value, "a phase")
    if not 0 <= phase < 1:
        raise InputError(f"a phase is {value!r}", "give parts of a period, from 0 to less than 1")
    return phase
