"""How pictures look in matplotlib: texts with formulae, colours, symbols and widths of lines."""

from __future__ import annotations

from typing import Any, Dict, Sequence, Tuple

from . import _graze

# gnuplot's types of points: matplotlib's marker, and whether it is filled.
_MARKERS = {1: ("+", True), 2: ("x", True), 3: ((8, 2, 0), True), 4: ("s", False), 5: ("s", True), 6: ("o", False),
            7: ("o", True), 8: ("^", False), 9: ("^", True), 10: ("v", False), 11: ("v", True), 12: ("D", False),
            13: ("D", True), 14: ("p", False), 15: ("p", True)}
_STROKES = (1, 2, 3)  # markers without an area
# Sizes that look alike, relative to the square that the library assumes.
_SIZES = {3: 1.3, 5: 0.95, 6: 0.95, 7: 1.15, 8: 1.05, 9: 1.25, 10: 1.05, 11: 1.25, 12: 0.75, 13: 0.85, 14: 1.1,
          15: 1.25}
# gnuplot's patterns
HATCHES = {0: None, 1: "xxx", 2: "xxxxxx", 3: None, 4: r"\\\\", 5: "////", 6: r"\\\\\\", 7: "//////"}
LINES = ("line", "dashed", "dotted")
POINT = 0.75  # gnuplot's line width 1, in points
USUAL_FONT = 9  # size of letters, in points, to which widths of lines refer
PER_INCH = 72


def _escaped(text: str) -> str:
    import matplotlib

    if matplotlib.rcParams["text.usetex"]:
        words = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "−": "$-$",
                 "→": r"$\rightarrow$", "·": r"$\cdot$", "°": r"$^\circ$", "…": r"\dots{}", "<": "$<$", ">": "$>$",
                 **{c: "\\" + c for c in "{}$&#_%"}}
        return "".join(words.get(c, c) for c in text)
    return text.replace("$", r"\$")


def _in_formula(text: str) -> str:
    return "".join("\\" + c if c in "{}$%&#_ " else " " if c in "\\^~" else c for c in text)


def markup(runs: Sequence[Tuple[str, str]]) -> str:
    """Letters with their look as matplotlib's text, with formulae between dollars."""
    looks = {"italic": r"\mathit{%s}", "lowered": r"_{\mathrm{%s}}", "raised": r"^{\mathrm{%s}}"}
    parts, formula = [], ""
    for text, look in runs:
        if look == "upright":
            if formula:
                parts.append(f"${formula}$")
                formula = ""
            parts.append(_escaped(text))
        else:
            formula += looks[look] % _in_formula(text)
    if formula:
        parts.append(f"${formula}$")
    return "".join(parts)


def lines_of(texts: Sequence[Any]) -> str:
    return "\n".join(markup(text) for text in texts)


def shown(colour: str) -> str:
    """Black is the colour of texts, which is white in dark styles."""
    import matplotlib
    from matplotlib.colors import to_hex

    return to_hex(matplotlib.rcParams["text.color"]) if colour == "#000000" else colour


class Look:
    """Sizes that depend on the font, all in points."""

    def __init__(self, font: float, dots: int) -> None:
        self.font = font
        self.stroke = font / USUAL_FONT
        self.mark = _graze.mark_size * font
        self.dot = min(2.8, max(0.4, 2.8 * (50 / max(dots, 1)) ** 0.27)) * self.stroke

    def width(self, style: str) -> float:
        return (1.1 if style in ("dotted", "impulses") else 1.3) * POINT * self.stroke

    def pattern(self, style: str) -> Tuple[float, float]:
        """Lengths of a dash and a gap."""
        return (1.05 * self.stroke, 2.05 * self.stroke) if style == "dotted" else (4 * self.stroke, 2.2 * self.stroke)

    def dashes(self, style: str, width: float) -> Any:
        import matplotlib

        if style not in ("dashed", "dotted"):
            return "-"
        scale = width if matplotlib.rcParams["lines.scale_dashes"] else 1
        return (0, tuple(length / scale for length in self.pattern(style)))

    def line(self, style: str, over: int = 0) -> Dict[str, Any]:
        width = self.width(style)
        return {"linestyle": self.dashes(style, width + 1.6 * over * POINT * self.stroke), "dash_capstyle": "butt",
                "linewidth": width + 1.6 * over * POINT * self.stroke, "marker": "none"}

    def marker(self, symbol: int, colour: str, size: float, width: float = 1.2) -> Dict[str, Any]:
        marker, filled = _MARKERS.get(symbol, ("o", True))
        edge = width * POINT * self.stroke if not filled or symbol in _STROKES else 0
        edge *= 0.6 if symbol == 3 else 1
        return {"marker": marker, "markersize": size * self.mark * _SIZES.get(symbol, 1), "markeredgewidth": edge,
                "markeredgecolor": colour, "markerfacecolor": colour if filled else "none", "linestyle": "none"}
