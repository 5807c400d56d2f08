"""The drawing of a model that is written in Python."""

from __future__ import annotations

from typing import Any

from ._keywords import toml_text
from ._model_arguments import a_dict, a_list, key_of, mistake
from ._model_lines import ModelLines

EXAMPLE = 'a dict, as in {"x": (-1, 1), "y": (-1, 1), "shapes": [{"kind": "circle", "at": (x, 0), "radius": 0.1}]}'


def write_drawing(out: ModelLines, drawing: Any) -> None:
    """Writes what docs/model-format.md calls [drawing], with its keys."""
    if drawing is None:
        return
    given = a_dict(drawing, "drawing", EXAMPLE)
    out.header("drawing", label="drawing")
    for key, value in given.items():
        label = f"drawing['{key}']"
        if key == "text":
            out.text("text", value, "drawing")
        elif key != "shapes":
            out.add(f"{key_of(key, label)} = {_value(out, value, label)}", label)
    for number, shape in enumerate(a_list(given.get("shapes", ()), "drawing['shapes']")):
        label = f"drawing['shapes'][{number}]"
        out.add("")
        out.add("[[drawing.shapes]]", label)
        for key, value in a_dict(shape, label, "a dict, as in {\"kind\": \"circle\", ...}").items():
            place = f"{label}['{key}']"
            if key in ("kind", "colour", "text"):
                if not isinstance(value, str):
                    raise mistake(place, "it is no text", "give a text")
                out.add(f"{key} = {toml_text(value)}", place)
            elif key == "modes":
                names = ", ".join(toml_text(key_of(name, place)) for name in a_list(value, place))
                out.add(f"modes = [{names}]", place)
            else:
                out.add(f"{key} = {_value(out, value, place)}", place)


def _value(out: ModelLines, value: Any, label: str) -> str:
    """A number, an expression, or a list of such."""
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(out, one, label) for one in value) + "]"
    return out.value(value, label)
