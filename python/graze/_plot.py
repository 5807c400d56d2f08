"""Pictures by matplotlib, from the same data as those of the program, and with its arrangement: colours, symbols,
legends, and labels that do not overlap."""

from __future__ import annotations

import base64
import html
import io
import math
from typing import Any, Callable, List, Optional, Sequence, Tuple

from . import _graze
from ._errors import InputError

# gnuplot's types of points: matplotlib's marker, and whether it is filled.
_MARKERS = {1: ("+", True), 2: ("x", True), 3: ((8, 2, 0), True), 4: ("s", False), 5: ("s", True), 6: ("o", False),
            7: ("o", True), 8: ("^", False), 9: ("^", True), 10: ("v", False), 11: ("v", True), 12: ("D", False),
            13: ("D", True), 14: ("p", False), 15: ("p", True)}
_STROKES = (1, 2, 3)  # markers without an area
# Sizes that look alike, relative to the square that the library assumes.
_SIZES = {3: 1.3, 5: 0.95, 6: 0.95, 7: 1.15, 8: 1.05, 9: 1.25, 10: 1.05, 11: 1.25, 12: 0.75, 13: 0.85, 14: 1.1,
          15: 1.25}
# gnuplot's patterns
_HATCHES = {0: None, 1: "xxx", 2: "xxxxxx", 3: None, 4: r"\\\\", 5: "////", 6: r"\\\\\\", 7: "//////"}
_LINES = ("line", "dashed", "dotted")
_POINT = 0.75  # gnuplot's line width 1, in points
_USUAL_FONT = 9  # size of letters, in points, to which widths of lines refer
_PER_INCH = 72


# Texts


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


def _markup(runs: Sequence[Tuple[str, str]]) -> str:
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


def _lines_of(texts: Sequence[Any]) -> str:
    return "\n".join(_markup(text) for text in texts)


# Series


def _shown(colour: str) -> str:
    """Black is the colour of texts, which is white in dark styles."""
    import matplotlib
    from matplotlib.colors import to_hex

    return to_hex(matplotlib.rcParams["text.color"]) if colour == "#000000" else colour


class _Look:
    """Sizes that depend on the font, all in points."""

    def __init__(self, font: float, dots: int) -> None:
        self.font = font
        self.stroke = font / _USUAL_FONT
        self.mark = _graze.mark_size * font
        self.dot = min(2.8, max(0.4, 2.8 * (50 / max(dots, 1)) ** 0.27)) * self.stroke

    def width(self, style: str) -> float:
        return (1.1 if style in ("dotted", "impulses") else 1.3) * _POINT * self.stroke

    def pattern(self, style: str) -> tuple:
        """Lengths of a dash and a gap."""
        return (1.05 * self.stroke, 2.05 * self.stroke) if style == "dotted" else (4 * self.stroke, 2.2 * self.stroke)

    def dashes(self, style: str, width: float) -> Any:
        import matplotlib

        if style not in ("dashed", "dotted"):
            return "-"
        scale = width if matplotlib.rcParams["lines.scale_dashes"] else 1
        return (0, tuple(length / scale for length in self.pattern(style)))

    def line(self, style: str, over: int = 0) -> dict:
        width = self.width(style)
        return {"linestyle": self.dashes(style, width + 1.6 * over * _POINT * self.stroke), "dash_capstyle": "butt",
                "linewidth": width + 1.6 * over * _POINT * self.stroke, "marker": "none"}

    def marker(self, symbol: int, colour: str, size: float, width: float = 1.2) -> dict:
        marker, filled = _MARKERS.get(symbol, ("o", True))
        edge = width * _POINT * self.stroke if not filled or symbol in _STROKES else 0
        edge *= 0.6 if symbol == 3 else 1
        return {"marker": marker, "markersize": size * self.mark * _SIZES.get(symbol, 1), "markeredgewidth": edge,
                "markeredgecolor": colour, "markerfacecolor": colour if filled else "none", "linestyle": "none"}


def _dots_of(panel: dict, layout: dict) -> int:
    """How many dots of a panel can be told apart."""
    import numpy

    grains, count = 2000, 0
    for series in panel["series"]:
        if series["style"] != "dots":
            continue
        shares = []
        for column, (low, high, logarithmic) in enumerate((layout["x"], layout["y"])):
            values = series["points"][:, column]
            with numpy.errstate(divide="ignore", invalid="ignore"):
                shares.append(numpy.log(values / low) / numpy.log(high / low) if logarithmic
                              else (values - low) / (high - low))
        share = numpy.stack(shares, 1)
        share = numpy.floor(grains * share[((share >= 0) & (share <= 1)).all(axis=1)])
        count += len(numpy.unique(share[:, 0] * (2 * grains) + share[:, 1]))
    return count


def _symbols_size(count: int) -> tuple:
    """Many symbols are smaller and thinner, so that they overlap less: size and width of lines."""
    return (0.35 if count > 1000 else 0.6 if count > 200 else 1), (0.7 if count > 200 else 1.2)


def _draw_dots(axes: Any, panel: dict, look: _Look) -> None:
    """The dots of all series as one artist, in a mixed order, so that no series covers the others."""
    import numpy
    from matplotlib.colors import to_rgba

    dotted = [series for series in panel["series"] if series["style"] == "dots" and len(series["points"])]
    if not dotted:
        return
    points = numpy.concatenate([series["points"] for series in dotted])
    if len(dotted) == 1:
        colours: Any = _shown(dotted[0]["colour"])
    else:
        order = numpy.random.RandomState(0).permutation(len(points))
        colours = numpy.concatenate([numpy.tile(to_rgba(_shown(series["colour"])), (len(series["points"]), 1))
                                     for series in dotted])[order]
        points = points[order]
    axes.scatter(*points.T, s=look.dot ** 2, c=colours, marker="o", linewidths=0, zorder=2)


def _draw_cells(axes: Any, series: dict) -> None:
    import numpy
    from matplotlib.collections import PolyCollection

    if not len(series["cells"]):
        return
    left, right, low, high = series["cells"].T
    around = ((left, low), (right, low), (right, high), (left, high))
    corners = numpy.stack([numpy.stack(corner, 1) for corner in around], axis=1)
    hatch = _HATCHES.get(series["hatch"])
    if hatch:
        look: dict = {"facecolors": "white", "edgecolors": _shown(series["colour"]), "linewidths": 0, "hatch": hatch}
    else:
        look = {"facecolors": _shown(series["colour"]), "edgecolors": "none", "antialiaseds": False}
    axes.add_collection(PolyCollection(corners, zorder=1, **look))


def _add_dashed(axes: Any, points: Any, style: str, look: _Look, **kind: Any) -> None:
    from ._artists import DashedLine

    axes.add_line(DashedLine(*points.T, *look.pattern(style), **kind))
    axes.autoscale_view()


def _draw_series(axes: Any, series: dict, look: _Look, over: int, with_cells: bool, after: int) -> None:
    style, colour, points = series["style"], _shown(series["colour"]), series["points"]
    if style == "cells":
        _draw_cells(axes, series)
    elif not len(points):
        return
    elif style in _LINES:
        if style == "line":
            axes.plot(*series["line"].T, color=colour, **look.line(style, over))
        else:
            _add_dashed(axes, series["line"], style, look, color=colour, **look.line(style, over))
        if series["line_mark"]:
            axes.plot(*series["line"].T, color=colour, markevery=0.12,
                      **look.marker(series["line_mark"], colour, 0.75))
    elif style == "impulses":  # spectra may coincide: the first are drawn wider than the later ones
        width = (1.1 + 0.6 * after) * _POINT * look.stroke
        axes.plot(*points.T, color=colour, **{**look.marker(7, colour, 0.45 + 0.2 * after), "linestyle": "-"},
                  linewidth=width)
    elif style == "circles":  # of several sizes, so that circles at the same point are all visible
        number = series["number_of_colour"]
        size = 1 if number >= 1000 else 1 + 0.4 * (number % 3)
        symbol = 6 if series["symbol"] == 7 else series["symbol"]
        axes.plot(*points.T, color=colour, **look.marker(symbol, colour, size))
    elif style == "symbols":
        size, width = _symbols_size(len(points))
        if with_cells:  # a white disc below makes the symbol visible on any colour
            axes.plot(*points.T, color="white", **look.marker(7, "white", 2))
        axes.plot(*points.T, color=colour, **look.marker(series["symbol"], colour, size, width))


def _draw_crosses(axes: Any, panel: dict, layers: Sequence[Any], look: _Look) -> None:
    """Crosses of several series in layers, so that no series covers the others."""
    for number, points in layers:
        series = panel["series"][number]
        size, width = _symbols_size(len(series["points"]))
        colour = _shown(series["colour"])
        axes.plot(*points.T, color=colour, **look.marker(series["symbol"], colour, size, width))


def _draw_panel(axes: Any, core: Any, index: int, panel: dict, look: _Look, covering: Sequence[int]) -> None:
    for x in panel["marks"]:
        axes.axvline(x, color="#808080", linestyle=look.dashes("dotted", 0.5), linewidth=0.5, zorder=1.5)
    with_cells = any(len(series["cells"]) for series in panel["series"])
    dots_drawn, drawn = False, 0
    for number, series in enumerate(panel["series"]):
        if series["only_in_legend"] or number < drawn:
            continue
        drawn, layers = core.crosses(index, number)
        if layers:
            _draw_crosses(axes, panel, layers, look)
            continue
        if series["style"] == "dots":
            if not dots_drawn:
                _draw_dots(axes, panel, look)
            dots_drawn = True
        else:
            _draw_series(axes, series, look, covering[number], with_cells, len(panel["series"]) - 1 - number)


# Legends


def _samples_of(axes: Any, entries: Sequence[dict], look: _Look) -> List[Any]:
    """Artists without data that show the looks in a legend; they belong to the axes, so that `axes.legend()` finds
    them."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Rectangle

    samples = []
    for entry in entries:
        style, colour, title = entry["style"], _shown(entry["colour"]), _markup(entry["text"])
        if not entry["sampled"]:
            kind = {"linestyle": "none"}
        elif style == "symbols":
            kind = look.marker(entry["symbol"], colour, 1)
        elif style == "circles":
            kind = look.marker(6 if entry["symbol"] == 7 else entry["symbol"], colour, 1)
        elif style == "dots":
            kind = look.marker(7, colour, 1)
        elif style == "cells":
            hatch = _HATCHES.get(entry["hatch"])
            samples.append(axes.add_patch(Rectangle((0, 0), 0, 0, label=title, linewidth=0, hatch=hatch,
                                                    facecolor="white" if hatch else colour, edgecolor=colour)))
            continue
        else:
            kind = look.line(style)
            if entry["line_mark"]:
                kind = {**look.marker(entry["line_mark"], colour, 0.75), "linestyle": kind["linestyle"],
                        "linewidth": kind["linewidth"]}
        samples.append(axes.add_line(Line2D([], [], color=colour, label=title, **kind)))
    return samples


def _legend_look(entries: Sequence[dict], look: _Look) -> dict:
    joined = any(entry["style"] in (*_LINES, "impulses") for entry in entries)
    return {"fontsize": _graze.legend_font * look.font, "frameon": False, "handlelength": 2.4 if joined else 1.2,
            "handletextpad": 0.5, "columnspacing": 1.6, "labelspacing": 0.3, "borderpad": 0, "borderaxespad": 0,
            "numpoints": 1, "handleheight": 0.8}


def _place_legend(owner: Any, samples: List[Any], entries: Sequence[dict], page: dict, look: _Look, figure: Any) -> Any:
    """The legend at the place that the program's picture has for it. @param owner axes or figure"""
    if not entries:
        return None
    boxes = [entry["box"] for entry in entries]
    top = max(box[3] for box in boxes)
    columns = sum(abs(box[3] - top) < 1 for box in boxes)
    middle = (min(box[0] for box in boxes) + max(box[2] for box in boxes)) / 2
    rows_first = [i for column in range(columns) for i in range(column, len(samples), columns)]
    samples = [samples[i] for i in rows_first]
    # It is part of the layout, so that notebooks, which cut pictures to what is in it, show it.
    return owner.legend(handles=samples, labels=[one.get_label() for one in samples], ncol=columns, loc="upper center",
                        bbox_to_anchor=(middle / page["width"], (top - 0.15 * look.font) / page["height"]),
                        bbox_transform=figure.transFigure, **_legend_look(entries, look))


def _inner_legend(axes: Any, panel: dict, entries: Sequence[dict], look: _Look) -> Any:
    """A legend inside of axes that the user gave, where it covers the fewest points. It has what was in the axes
    before too."""
    _samples_of(axes, entries, look)
    handles, labels = axes.get_legend_handles_labels()
    seen, kept = set(), []
    for handle, label in zip(handles, labels):
        colour = getattr(handle, "get_color", lambda: None)()
        key = (label, str(colour), str(getattr(handle, "get_linestyle", lambda: None)()))
        if key not in seen:
            kept.append((handle, label))
            seen.add(key)
    if not kept:
        return None
    kind = {**_legend_look(entries, look), "frameon": True, "framealpha": 0.8, "borderpad": 0.4, "borderaxespad": 0.4}
    legend = axes.legend(*zip(*kept), loc="upper right", **kind)
    place = _emptiest(axes, panel, legend)
    if place != 1:
        legend = axes.legend(*zip(*kept), loc=place, **kind)
    return legend


def _emptiest(axes: Any, panel: dict, legend: Any) -> int:
    """Matplotlib's number of the place in axes at which a legend covers the fewest points and labels."""
    import numpy

    try:
        box = legend.get_window_extent()
        frame = axes.bbox
        width, height = box.width / frame.width, box.height / frame.height
        points = [series["line"] for series in panel["series"] if len(series["line"])]
        points += [series["cells"][:, [0, 2]] for series in panel["series"] if len(series["cells"])]
        points += [numpy.array([label["at"]]) for label in panel["labels"] for _ in range(20)]
        if not points or not (width > 0 and height > 0):
            return 1
        shown = axes.transAxes.inverted().transform(axes.transData.transform(numpy.concatenate(points)))
    except (ValueError, RuntimeError, ZeroDivisionError):
        return 1
    shown = shown[numpy.isfinite(shown).all(axis=1)]
    edges = {1: (1, 1), 2: (0, 1), 3: (0, 0), 4: (1, 0), 9: (0.5, 1), 8: (0.5, 0), 7: (1, 0.5), 6: (0, 0.5),
             10: (0.5, 0.5)}

    def covered(place: int) -> int:
        left, low = edges[place][0] * (1 - width), edges[place][1] * (1 - height)
        inside = (shown > (left - 0.02, low - 0.02)) & (shown < (left + width + 0.02, low + height + 0.02))
        return int(inside.all(axis=1).sum())

    return min(edges, key=covered)


# Labels of points


class _Notes:
    """Sentences under a panel: its own, then those about labels that have no room."""

    def __init__(self, panel: dict, symbols: List[str], width: float, font: float, text: Any) -> None:
        self._own, self._symbols, self._text = panel["notes"], symbols, text
        self._room = width / (_graze.legend_font * font)

    def tell(self, of_labels: Sequence[str] = ()) -> None:
        lines: List[str] = []
        for note in (*self._own, *of_labels):
            lines += _graze.wrapped_lines(note, self._room, 3)
        self._text.set_text(_lines_of([_graze.rich_words(line, self._symbols) for line in lines]))


# Axes


def _set_limits(axes: Any, layout: dict) -> None:
    """The limits of the program's picture. What is drawn later into the axes may still widen them."""
    axes.set_xlim(*layout["x"][:2], auto=None)
    axes.set_ylim(*layout["y"][:2], auto=None)


def _set_scales(axes: Any, panel: dict) -> None:
    if panel["logarithmic_x"]:
        axes.set_xscale("log")
    if panel["logarithmic_y"]:
        axes.set_yscale("log")


def _dress(axes: Any, font: float, family: str) -> None:
    """Tics and frame of axes on a page of our own."""
    from matplotlib.ticker import ScalarFormatter

    from ._artists import Tics

    stroke = font / _USUAL_FONT
    axes.tick_params(which="major", labelsize=font, length=0.3 * font, width=0.8 * _POINT * stroke, pad=0.3 * font)
    axes.tick_params(which="minor", length=0.18 * font, width=0.6 * _POINT * stroke)
    for spine in axes.spines.values():
        spine.set_linewidth(0.8 * _POINT * stroke)
    for axis in (axes.xaxis, axes.yaxis):
        axis.offsetText.set_fontsize(font)
        if axis.get_scale() == "linear":
            formatter = ScalarFormatter(useOffset=False, useMathText=True)
            formatter.set_powerlimits((-4, 5))
            axis.set_major_formatter(formatter)
            axis.set_major_locator(Tics(font))
        if family:  # tics are made when they are drawn, with the font that is usual then
            axis.get_major_ticks(20)
            axis.get_minor_ticks(20)


def _label_axes(axes: Any, texts: dict, font: float, pad: float) -> None:
    axes.set_xlabel(_lines_of(texts["x_label"]), fontsize=font, labelpad=pad)
    axes.set_ylabel(_lines_of(texts["y_label"]), fontsize=font, labelpad=pad)


def _drawn_on_page(core: Any, page_of: Callable[..., Any]) -> Any:
    """Draws a figure on a page of its own, arranged as the program does. @param page_of makes matplotlib's figure"""
    import matplotlib
    import numpy

    page, style = core.layout(), core.style
    font, width, height = page["font"], page["width"], page["height"]
    plain: dict = {"figure.autolayout": False, "figure.constrained_layout.use": False}
    if style["font"]:
        plain["font.family"] = [style["font"], *matplotlib.rcParams["font.family"]]
    # Not within the context: the first figure loads the backend, which in notebooks sets parameters for good.
    figure = page_of(figsize=(width / _PER_INCH, height / _PER_INCH))
    with matplotlib.rc_context(plain):
        figure.set_layout_engine(None)
        if page["title"]:
            figure.suptitle(_lines_of(page["title"]), x=0.5, y=page["title_top"] / height, va="top",
                            fontsize=1.1 * font)
        panels = core.panels()
        look = _Look(font, max(map(_dots_of, panels, page["panels"]), default=0))
        drawn = []
        for number, (panel, layout) in enumerate(zip(panels, page["panels"])):
            left, low, right, high = layout["frame"]
            if layout["y_power"] and not layout["title"]:  # the power of ten stands above
                high = min(high, page["title_low"] - 1.6 * font)
            axes = figure.add_axes([left / width, low / height, (right - left) / width, (high - low) / height])
            drawn.append(axes)
            _set_scales(axes, panel)
            _draw_panel(axes, core, number, panel, look, layout["covering"])
            _set_limits(axes, layout)
            _dress(axes, font, style["font"])
            # Tics have a power of ten of their own: labels that were set later would not know it.
            _label_axes(axes, core.texts(number, right - left, high - low, font), font, 0.2 * font)
            axes.set_title(_lines_of(layout["title"]), fontsize=font, pad=0.4 * font)
            note: Optional[_Notes] = None
            if layout["notes"]:
                x, y = layout["notes_at"]
                text = figure.text(x / width, y / height, "", fontsize=_graze.legend_font * font, ha="left", va="top",
                                   linespacing=1.25)
                room = max(right, width if page["panels"][-1] is layout else right) - x
                note = _Notes(panel, core.symbols, room, font, text)
                text.set_text(_lines_of(layout["notes"]))
            samples = _samples_of(axes, layout["legend"], look)
            legend = _place_legend(axes, samples, layout["legend"], page, look, figure)
            _arranged_labels(axes, core, number, panel, font, note, legend)
            if not any(len(series["points"]) or len(series["cells"]) for series in panel["series"]):
                axes.text(0.5, 0.5, "no data", transform=axes.transAxes, ha="center", va="center", fontsize=font)
        if page["legend"] and drawn:
            _place_legend(figure, _samples_of(drawn[0], page["legend"], look), page["legend"], page, look, figure)
    return drawn[0] if len(drawn) == 1 else numpy.array(drawn)


def _arranged_labels(axes: Any, core: Any, number: int, panel: dict, font: float, note: Any, legend: Any) -> None:
    if panel["labels"]:
        from ._artists import PointLabels

        PointLabels(axes, core, number, font, 0.5 * _POINT * font / _USUAL_FONT, note, legend).arrange()


def _drawn_into(core: Any, given: List[Any]) -> Any:
    """Draws a figure into axes that the user gave, one for each panel."""
    import numpy

    page, panels = core.layout(), core.panels()
    for number, (axes, panel, layout) in enumerate(zip(given, panels, page["panels"])):
        before = axes.has_data()
        font = axes.xaxis.label.get_fontsize()
        look = _Look(font, max(map(_dots_of, panels, page["panels"]), default=0))
        _set_scales(axes, panel)
        points = _PER_INCH / axes.figure.dpi
        box = axes.bbox
        if not before:
            _set_limits(axes, layout)
        covering = core.covering(number, box.width * points, box.height * points, layout["x"], layout["y"])
        _draw_panel(axes, core, number, panel, look, covering)
        if not before:
            _set_limits(axes, layout)
        else:
            axes.autoscale_view()
        texts = core.texts(number, max(box.width * points, 1), max(box.height * points, 1), font)
        if not axes.get_xlabel():
            axes.set_xlabel(_lines_of(texts["x_label"]))
        if not axes.get_ylabel():
            axes.set_ylabel(_lines_of(texts["y_label"]))
        if not axes.get_title():
            words = [_graze.rich_words(core.title, core.symbols)] if core.title and len(panels) == 1 else texts["title"]
            axes.set_title(_lines_of(words))
        entries = (page["legend"] if number == 0 else []) if page["legend"] else texts["legend"]
        legend = _inner_legend(axes, panel, entries, look) if entries else axes.get_legend()
        text = axes.annotate("", (0, 0), xycoords="axes fraction", xytext=(0, -3.6 * font), textcoords="offset points",
                             ha="left", va="top", fontsize=_graze.legend_font * font, annotation_clip=False)
        note = _Notes(panel, core.symbols, box.width * points, font, text)
        note.tell()
        _arranged_labels(axes, core, number, panel, font, note, legend)
    return given[0] if len(given) == 1 else numpy.array(given)


def _checked_axes(axes: Any, panels: int) -> List[Any]:
    import numpy
    from matplotlib.axes import Axes

    given = list(numpy.atleast_1d(numpy.asarray(axes, dtype=object)).ravel())
    for one in given:
        if not isinstance(one, Axes) or one.name != "rectilinear":
            raise InputError(f"axes has an object of type {type(one).__name__}",
                             "give plane axes of matplotlib, as pyplot.subplots() returns them")
    if len(given) != panels:
        raise InputError(f"{len(given)} axes were given, and there {'is' if panels == 1 else 'are'} {panels} "
                         f"panel{'' if panels == 1 else 's'}", "give one for each panel, or none")
    if len(set(map(id, given))) != len(given):
        raise InputError("the same axes were given twice", "give one for each panel")
    return given


def draw(core: Any, axes: Any = None) -> Any:
    """Draws a figure of the library. axes: the one axes, or the sequence of as many as there are panels, to draw into;
    pyplot is not touched then. Without them a figure of pyplot is made, of the size and arrangement of the program's
    picture. Returns the axes: one, or an array of several.

    Raises InputError if there are not as many axes as panels."""
    if axes is not None:
        return _drawn_into(core, _checked_axes(axes, len(core.panels())))
    from matplotlib import pyplot

    return _drawn_on_page(core, pyplot.figure)


class Figure:
    """The data of a picture, as the program draws it.

    `title`; `panels`, a list of dicts with labels of axes, units, ranges, `series` (each with `points`, an array of two
    columns, `style`, `colour` and the `title` in the legend) and `labels` of points; `plot(axes=None)` draws it.
    """

    def __init__(self, core: Any) -> None:
        self._core = core
        self.title, self.symbols = core.title, core.symbols
        self.panels = core.panels()

    def plot(self, *, axes: Any = None) -> Any:
        """Draws it with matplotlib and returns the axes."""
        return draw(self._core, axes)

    def __repr__(self) -> str:
        series = sum(not one["only_in_legend"] for panel in self.panels for one in panel["series"])
        return f"<Figure of {len(self.panels)} panel{'s' * (len(self.panels) != 1)} with {series} series>"

    def _repr_html_(self) -> str:
        return small_picture(lambda: self._core, repr(self))


# Multipliers


def draw_multipliers(multipliers: Any, title: str, axes: Any = None) -> Any:
    """Multipliers in the complex plane, with the unit circle: those inside filled, those on it and outside hollow. What
    is farther out than three times the circle is drawn at the frame in its direction, with its value beside it."""
    import numpy

    if axes is None:
        from matplotlib import pyplot

        axes = pyplot.figure(figsize=(3.8, 3.8), layout="constrained").add_subplot()
    else:
        axes = _checked_axes(axes, 1)[0]
    values = numpy.asarray(multipliers, dtype=complex)
    values = values[numpy.isfinite(values)]
    farthest = 3.0
    far = abs(values) > farthest
    reach = farthest if far.any() else max(1.3, 1.1 * abs(values).max(initial=0))
    look = _Look(_USUAL_FONT, 0)
    angle = numpy.linspace(0, 2 * math.pi, 361)
    axes.plot(numpy.cos(angle), numpy.sin(angle), color="#808080", linewidth=look.width("line"))
    axes.axhline(0, color="#b0b0b0", linewidth=0.5, zorder=1)
    axes.axvline(0, color="#b0b0b0", linewidth=0.5, zorder=1)
    inside = abs(values) < 1
    for chosen, symbol, colour, words in ((inside, 7, _graze.colour(0, False), "inside of the unit circle"),
                                          (~inside & ~far, 6, _graze.colour(1, False), "on or outside of it"),
                                          (far, 12, _graze.colour(1, False), "far outside, with its value")):
        if not chosen.any():
            continue
        shown = values[chosen]
        if chosen is far:
            shown = reach * shown / abs(shown)
            for value, place in zip(values[far], shown):
                text = f"{value.real:.4g}" if value.imag == 0 else f"{value.real:.4g}{value.imag:+.4g}i"
                axes.annotate(text.replace("-", "−"), (place.real, place.imag), xytext=(0, 6),
                              textcoords="offset points", ha="left" if place.real < 0 else "right", fontsize="small")
        axes.plot(shown.real, shown.imag, color=colour, label=words, **look.marker(symbol, colour, 1.2))
    edge = 1.1 * reach
    axes.set_xlim(-edge, edge, auto=None)
    axes.set_ylim(-edge, edge, auto=None)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("real part of the multiplier")
    axes.set_ylabel("imaginary part of the multiplier")
    axes.set_title(title, fontsize="medium")
    if len(values):
        axes.legend(fontsize="small", loc="upper left")
    return axes


# Notebooks

_SMALL = 110.0  # mm
_LARGEST_PICTURE = 44_000  # bytes; a third more as text


def page_alone(core: Any) -> Any:
    """A figure of matplotlib that pyplot does not know, with the picture."""
    import numpy
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Page

    def page_of(**size: Any) -> Any:
        page = Page(**size)
        FigureCanvasAgg(page)
        return page

    return numpy.atleast_1d(_drawn_on_page(core, page_of)).ravel()[0].figure


def small_picture(figure: Callable[[], Any], caption: str) -> str:
    """HTML with a small picture for notebooks, or only with the caption where matplotlib is missing, nothing can be
    drawn, or the picture would be large.

    figure: a function that gives a figure of the library, or None for no picture.
    """
    text = f"<p>{html.escape(caption)}</p>"
    try:
        core = figure()
        if core is None:
            return text
        page = page_alone(core.resized(_SMALL))
        for dots in (96, 60):
            data = io.BytesIO()
            page.savefig(data, format="png", dpi=dots)
            if data.tell() < _LARGEST_PICTURE:
                break
        else:
            return text
    except Exception:  # noqa: BLE001 - a representation never raises
        return text
    code = base64.b64encode(data.getvalue()).decode()
    return f'<img src="data:image/png;base64,{code}" alt="{html.escape(caption)}">{text}'
