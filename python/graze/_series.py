"""The series of a panel, drawn by matplotlib."""

from __future__ import annotations

from typing import Any, Dict, Sequence, Tuple

from ._looks import HATCHES, LINES, POINT, Look, shown


def dots_of(panel: Dict[str, Any], layout: Dict[str, Any]) -> int:
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


def _symbols_size(count: int) -> Tuple[float, float]:
    """Many symbols are smaller and thinner, so that they overlap less: size and width of lines."""
    return (0.35 if count > 1000 else 0.6 if count > 200 else 1), (0.7 if count > 200 else 1.2)


def _draw_dots(axes: Any, panel: Dict[str, Any], look: Look) -> None:
    """The dots of all series as one artist, in a mixed order, so that no series covers the others."""
    import numpy
    from matplotlib.colors import to_rgba

    dotted = [series for series in panel["series"] if series["style"] == "dots" and len(series["points"])]
    if not dotted:
        return
    points = numpy.concatenate([series["points"] for series in dotted])
    if len(dotted) == 1:
        colours: Any = shown(dotted[0]["colour"])
    else:
        order = numpy.random.RandomState(0).permutation(len(points))
        colours = numpy.concatenate([numpy.tile(to_rgba(shown(series["colour"])), (len(series["points"]), 1))
                                     for series in dotted])[order]
        points = points[order]
    axes.scatter(*points.T, s=look.dot ** 2, c=colours, marker="o", linewidths=0, zorder=2)


def _draw_cells(axes: Any, series: Dict[str, Any]) -> None:
    import numpy
    from matplotlib.collections import PolyCollection

    if not len(series["cells"]):
        return
    left, right, low, high = series["cells"].T
    around = ((left, low), (right, low), (right, high), (left, high))
    corners = numpy.stack([numpy.stack(corner, 1) for corner in around], axis=1)
    hatch = HATCHES.get(series["hatch"])
    if hatch:
        look: Dict[str, Any] = {"facecolors": "white", "edgecolors": shown(series["colour"]), "linewidths": 0,
                                "hatch": hatch}
    else:
        look = {"facecolors": shown(series["colour"]), "edgecolors": "none", "antialiaseds": False}
    axes.add_collection(PolyCollection(corners, zorder=1, **look))


def _add_dashed(axes: Any, points: Any, style: str, look: Look, **kind: Any) -> None:
    from ._artists import DashedLine

    axes.add_line(DashedLine(*points.T, *look.pattern(style), **kind))
    axes.autoscale_view()


def _draw_series(axes: Any, series: Dict[str, Any], look: Look, over: int, with_cells: bool, after: int) -> None:
    style, colour, points = series["style"], shown(series["colour"]), series["points"]
    if style == "cells":
        _draw_cells(axes, series)
    elif not len(points):
        return
    elif style in LINES:
        if style == "line":
            axes.plot(*series["line"].T, color=colour, **look.line(style, over))
        else:
            _add_dashed(axes, series["line"], style, look, color=colour, **look.line(style, over))
        if series["line_mark"]:
            axes.plot(*series["line"].T, color=colour, markevery=0.12,
                      **look.marker(series["line_mark"], colour, 0.75))
    elif style == "impulses":  # spectra may coincide: the first are drawn wider than the later ones
        width = (1.1 + 0.6 * after) * POINT * look.stroke
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


def _draw_crosses(axes: Any, panel: Dict[str, Any], layers: Sequence[Any], look: Look) -> None:
    """Crosses of several series in layers, so that no series covers the others."""
    for number, points in layers:
        series = panel["series"][number]
        size, width = _symbols_size(len(series["points"]))
        colour = shown(series["colour"])
        axes.plot(*points.T, color=colour, **look.marker(series["symbol"], colour, size, width))


def draw_panel(axes: Any, core: Any, index: int, panel: Dict[str, Any], look: Look, covering: Sequence[int]) -> None:
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
