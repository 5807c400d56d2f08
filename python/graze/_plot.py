"""Pictures by matplotlib, from the same data as those of the program."""

from __future__ import annotations

import base64
import html
import io

_COLOURS = ["#1f77b4", "#d62728", "#2ca02c", "#ff7f0e", "#9467bd", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22", "#17becf"]
# gnuplot's types of points
_SYMBOLS = {1: "+", 2: "x", 3: "*", 4: "s", 5: "s", 6: "o", 7: "o", 8: "^", 9: "^", 10: "v", 11: "v", 12: "D", 13: "D",
            14: "p", 15: "p"}
_HOLLOW = {4, 6, 8, 10, 12, 14}
_HATCHES = {0: None, 1: "//", 2: "\\\\", 4: "xx", 5: "..", 6: "--"}


def _colour(of) -> str:
    return {"grey": "0.6", "black": "black"}.get(of) or _COLOURS[of % len(_COLOURS)]


def _axis_label(words: str, name: str, unit: str) -> str:
    text = ", ".join(part for part in (words, name) if part)
    return f"{text} ({unit})" if unit else text


def _draw_series(axes, series):
    import numpy
    from matplotlib.collections import PolyCollection

    colour, points, label = _colour(series["colour"]), series["points"], series["title"] or None
    if series["only_in_legend"]:
        points = numpy.full((1, 2), numpy.nan)
    x, y = points.T if len(points) else (numpy.empty(0), numpy.empty(0))
    style = series["style"]
    if style == "cells":
        left, right, low, high = series["cells"].T if len(series["cells"]) else numpy.empty((4, 0))
        corners = numpy.stack([numpy.stack([left, low], 1), numpy.stack([right, low], 1),
                               numpy.stack([right, high], 1), numpy.stack([left, high], 1)], axis=1)
        axes.add_collection(PolyCollection(corners, facecolors=colour, edgecolors="none", label=label,
                                           hatch=_HATCHES.get(series["hatch"])))
        axes.autoscale_view()
    elif style in ("line", "dashed", "dotted"):
        axes.plot(x, y, {"line": "-", "dashed": "--", "dotted": ":"}[style], color=colour, linewidth=1.2, label=label)
    elif style == "impulses":
        axes.vlines(x, 0, y, colors=colour, linewidth=1, label=label)
    else:
        symbol = series["symbol"] if style == "symbols" else 6 if style == "circles" else 7
        size = 5 if style == "symbols" else 3 if style == "circles" else 1
        hollow = symbol in _HOLLOW
        axes.plot(x, y, _SYMBOLS.get(symbol, "o"), linestyle="none", color=colour, markersize=size, label=label,
                  markerfacecolor="none" if hollow else colour, markeredgewidth=1 if hollow or symbol < 4 else 0)


def _draw_panel(axes, panel):
    for series in panel["series"]:
        _draw_series(axes, series)
    for x in panel["marks"]:
        axes.axvline(x, color="0.75", linewidth=0.5)
    for label in panel["labels"]:
        axes.annotate(label["text"], label["at"], xytext=(3, 3), textcoords="offset points", fontsize="small",
                      color=_colour(label["colour"]))
    axes.set_xlabel(_axis_label(panel["x_words"], panel["x_label"], panel["x_unit"]))
    axes.set_ylabel(_axis_label(panel["y_words"], panel["y_label"], panel["y_unit"]))
    axes.set_title(panel["title"], fontsize="medium")
    if panel["logarithmic_x"]:
        axes.set_xscale("log")
    if panel["logarithmic_y"]:
        axes.set_yscale("log")
    if panel["x_range"]:
        axes.set_xlim(*panel["x_range"])
    if panel["y_range"]:
        axes.set_ylim(*panel["y_range"])
    if any(series["title"] for series in panel["series"]):
        axes.legend(fontsize="small")


def draw(figure, axes=None):
    """Draws a figure. axes: the one axes, or the sequence of as many as there are panels, to draw into. Returns the axes:
    one, or an array of several."""
    import numpy

    panels = figure["panels"]
    if axes is None:
        from matplotlib import pyplot

        columns = max(1, figure["columns"])
        spanned = sum(panel["rows"] for panel in panels)
        rows = -(-spanned // columns)
        picture = pyplot.figure(figsize=(6.4 * columns, max(3.2, 2.6 * rows) if rows > 1 else 4.4), layout="constrained")
        grid = picture.add_gridspec(rows, columns)
        taken, all_axes = numpy.zeros((rows, columns), dtype=bool), []
        for panel in panels:
            row, column = numpy.argwhere(~taken)[0]
            taken[row:row + panel["rows"], column] = True
            all_axes.append(picture.add_subplot(grid[row:row + panel["rows"], column]))
        if figure["title"]:
            picture.suptitle(figure["title"], fontsize="large")
    else:
        all_axes = list(numpy.atleast_1d(axes).ravel())
        if len(all_axes) != len(panels):
            from ._errors import InputError

            raise InputError(f"{len(all_axes)} axes were given, and there are {len(panels)} panels",
                             "give as many, or none")
    for panel, one in zip(panels, all_axes):
        _draw_panel(one, panel)
    return all_axes[0] if len(all_axes) == 1 else numpy.array(all_axes)


def small_picture(plot, caption: str) -> str:
    """HTML with a picture for notebooks, or only with the caption where matplotlib is missing or nothing can be drawn."""
    from ._errors import Error

    text = f"<p>{html.escape(caption)}</p>"
    try:
        import numpy
        from matplotlib import pyplot
    except ImportError:
        return text
    try:
        with pyplot.ioff():
            axes = plot()
        picture = numpy.atleast_1d(axes).ravel()[0].figure
        data = io.BytesIO()
        picture.savefig(data, format="png", dpi=60)
        pyplot.close(picture)
    except (Error, ValueError):
        return text
    return f'<img src="data:image/png;base64,{base64.b64encode(data.getvalue()).decode()}" alt="{html.escape(caption)}">{text}'
