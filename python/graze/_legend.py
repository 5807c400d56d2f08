"""Legends."""

from __future__ import annotations

from typing import Any, Dict, List, Sequence

from . import _graze
from ._looks import HATCHES, LINES, Look, markup, shown


def samples_of(axes: Any, entries: Sequence[Dict[str, Any]], look: Look) -> List[Any]:
    """Artists without data that show the looks in a legend; they belong to the axes, so that `axes.legend()` finds
    them."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Rectangle

    samples = []
    for entry in entries:
        style, colour, title = entry["style"], shown(entry["colour"]), markup(entry["text"])
        if not entry["sampled"]:
            kind = {"linestyle": "none"}
        elif style == "symbols":
            kind = look.marker(entry["symbol"], colour, 1)
        elif style == "circles":
            kind = look.marker(6 if entry["symbol"] == 7 else entry["symbol"], colour, 1)
        elif style == "dots":
            kind = look.marker(7, colour, 1)
        elif style == "cells":
            hatch = HATCHES.get(entry["hatch"])
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


def _legend_look(entries: Sequence[Dict[str, Any]], look: Look) -> Dict[str, Any]:
    joined = any(entry["style"] in (*LINES, "impulses") for entry in entries)
    return {"fontsize": _graze.legend_font * look.font, "frameon": False, "handlelength": 2.4 if joined else 1.2,
            "handletextpad": 0.5, "columnspacing": 1.6, "labelspacing": 0.3, "borderpad": 0, "borderaxespad": 0,
            "numpoints": 1, "handleheight": 0.8}


def place_legend(owner: Any, samples: List[Any], entries: Sequence[Dict[str, Any]], page: Dict[str, Any], look: Look,
                 figure: Any) -> Any:
    """The legend at the place that the program's picture has for it. owner: axes or figure."""
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


def inner_legend(axes: Any, panel: Dict[str, Any], entries: Sequence[Dict[str, Any]], look: Look) -> Any:
    """A legend inside of axes that the user gave, where it covers the fewest points. It has what was in the axes
    before too."""
    samples_of(axes, entries, look)
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


def _emptiest(axes: Any, panel: Dict[str, Any], legend: Any) -> int:
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
