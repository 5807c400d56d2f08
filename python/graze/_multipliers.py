"""The picture of multipliers in the complex plane."""

from __future__ import annotations

import math
from typing import Any

from . import _graze
from ._looks import USUAL_FONT, Look
from ._plot import checked_axes


def draw_multipliers(multipliers: Any, title: str, axes: Any = None) -> Any:
    """Multipliers in the complex plane, with the unit circle: those inside filled, those on it and outside hollow. What
    is farther out than three times the circle is drawn at the frame in its direction, with its value beside it."""
    import numpy

    if axes is None:
        from matplotlib import pyplot

        axes = pyplot.figure(figsize=(3.8, 3.8), layout="constrained").add_subplot()
    else:
        axes = checked_axes(axes, 1)[0]
    values = numpy.asarray(multipliers, dtype=complex)
    values = values[numpy.isfinite(values)]
    farthest = 3.0
    far = abs(values) > farthest
    reach = farthest if far.any() else max(1.3, 1.1 * abs(values).max(initial=0))
    look = Look(USUAL_FONT, 0)
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
