"""What matplotlib asks for when a picture is drawn: places of labels, and tics. Importing this imports matplotlib."""

from __future__ import annotations

from typing import Any, Dict, List, Tuple

import numpy
from matplotlib.artist import Artist
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.ticker import Locator, MaxNLocator
from matplotlib.transforms import IdentityTransform

from . import _graze
from ._errors import InputError
from ._looks import PER_INCH, shown


class Tics(Locator):
    """Tics of linear axes at the values of the program's picture: as many as have room without overlapping labels."""

    def __init__(self, font: float) -> None:
        self._font = font
        self._usual = MaxNLocator(nbins=6, steps=[1, 2, 5, 10])

    def __call__(self) -> Any:
        return self.tick_values(*self.axis.get_view_interval())

    def tick_values(self, vmin: float, vmax: float) -> Any:
        axes = self.axis.axes
        horizontal = self.axis.axis_name == "x"
        box = axes.bbox
        length = (box.width if horizontal else box.height) * PER_INCH / axes.figure.dpi
        try:
            return _graze.tics(vmin, vmax, horizontal, length, self._font)
        except (InputError, ValueError):
            return self._usual.tick_values(vmin, vmax)


class DashedLine(Line2D):
    """A line whose dashes depend on the place on the page only: where lines coincide, as the two sides of a branch that
    returns, their dashes do too, and the gaps stay open."""

    def __init__(self, x: Any, y: Any, dash: float, gap: float, **look: Any) -> None:
        super().__init__(x, y, **look)
        self._pattern = (dash, gap)  # in points

    def draw(self, renderer: Any) -> None:
        if not self.get_visible() or self.axes is None:
            return
        pixels = renderer.points_to_pixels(1.0)
        points = self.get_transform().transform(numpy.asarray(self.get_xydata(), dtype=float)) / pixels
        frame = self.axes.bbox.extents / pixels
        vertices, counts = _graze.dashes(points, *self._pattern, list(frame))
        self.stale = False
        if not len(counts):
            return
        codes = numpy.full(len(vertices), Path.LINETO, dtype=Path.code_type)
        codes[numpy.concatenate([[0], numpy.cumsum(counts)[:-1]])] = Path.MOVETO
        renderer.open_group("line2d", self.get_gid())
        pen = renderer.new_gc()
        self._set_gc_clip(pen)
        pen.set_url(self.get_url())
        pen.set_foreground(self.get_color())
        pen.set_alpha(self.get_alpha())
        pen.set_antialiased(self.get_antialiased())
        pen.set_linewidth(self.get_linewidth())
        pen.set_capstyle("butt")
        pen.set_joinstyle("round")
        renderer.draw_path(pen, Path(vertices * pixels, codes), IdentityTransform())
        pen.restore()
        renderer.close_group("line2d")


class PointLabels(Artist):
    """Keeps the labels of a panel (annotations in `axes.texts`) where they overlap neither one another nor lines and
    symbols. It finds their places anew when the limits or the size of the axes have changed."""

    def __init__(self, axes: Any, figure: Any, number: int, count: int, font: float, line: float, note: Any,
                 legend: Any) -> None:
        """figure, number: the compiled figure and the number of its panel. count: of labels."""
        super().__init__()
        self._core, self._number, self._font = figure, number, font
        self._note, self._legend = note, legend
        self._known: Any = None
        self.labels: List[Any] = []
        self.set_zorder(-1)  # it is drawn before what it arranges
        self.set_in_layout(False)
        axes.add_artist(self)
        size = _graze.label_font * font
        for _ in range(count):
            label = axes.annotate("", (0, 0), xytext=(0, 0), textcoords="offset points", ha="center", va="center",
                                  fontsize=size, annotation_clip=False, visible=False, zorder=4,
                                  arrowprops={"arrowstyle": "-", "linewidth": line, "color": "#606060", "shrinkA": 0,
                                              "shrinkB": _graze.mark_size * font / 2})
            label.set_in_layout(False)
            self.labels.append(label)

    def __getstate__(self) -> Dict[str, Any]:  # the compiled figure is left behind, and labels stay where they are
        return {**super().__getstate__(), "_core": None, "_legend": None, "_note": None}

    def _state(self) -> Tuple[Any, ...]:
        axes = self.axes
        box = axes.bbox
        points = PER_INCH / axes.figure.dpi
        avoided = []
        if self._legend is not None and self._legend.axes is axes and self._legend.get_frame_on():
            legend = self._legend.get_window_extent()
            avoided.append(tuple(round(points * (edge - start), 2) for edge, start in
                                 zip(legend.extents, (box.x0, box.y0, box.x0, box.y0))))
        return (round(box.width * points, 2), round(box.height * points, 2), (*axes.get_xlim(), axes.get_xscale()),
                (*axes.get_ylim(), axes.get_yscale()), tuple(avoided))

    def arrange(self) -> None:
        """Finds places for the labels, if something has changed."""
        if self._core is None:
            return
        state = self._state()
        if state == self._known:
            return
        self._known = state
        width, height, (left, right, across), (low, high, up), avoided = state
        if {across, up} - {"linear", "log"}:
            return
        try:
            places = self._core.places(self._number, width, height, (left, right, across == "log"),
                                       (low, high, up == "log"), self._font, [list(box) for box in avoided])
        except InputError:
            return
        for label in self.labels:
            label.set_visible(False)
        for label, place in zip(self.labels, places["labels"]):
            label.set_text(place["text"].replace("$", r"\$"))
            label.set_color(shown(place["colour"]))
            label.xy = place["at"]
            label.set_position(place["offset"])
            label._arrow_relpos = place["leader_end"]
            label.arrow_patch.set_visible(place["led"])
            label.set_visible(True)
        if self._note is not None:
            self._note.tell(places["notes"])

    def draw(self, renderer: Any) -> None:
        self.arrange()
