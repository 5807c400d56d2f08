"""Pictures by matplotlib, from the same data as those of the program, and with its arrangement: colours, symbols,
legends, and labels that do not overlap."""

from __future__ import annotations

import base64
import html
import io
from typing import Any, Callable, Dict, List, Optional, Sequence

from . import _graze
from ._errors import InputError
from ._legend import inner_legend, place_legend, samples_of
from ._looks import PER_INCH, POINT, USUAL_FONT, Look, lines_of
from ._series import dots_of, draw_panel


class _Notes:
    """Sentences under a panel: its own, then those about labels that have no room."""

    def __init__(self, panel: Dict[str, Any], symbols: List[str], width: float, font: float, text: Any) -> None:
        self._own, self._symbols, self._text = panel["notes"], symbols, text
        self._room = width / (_graze.legend_font * font)

    def tell(self, of_labels: Sequence[str] = ()) -> None:
        lines: List[str] = []
        for note in (*self._own, *of_labels):
            lines += _graze.wrapped_lines(note, self._room, 3)
        self._text.set_text(lines_of([_graze.rich_words(line, self._symbols) for line in lines]))


def _set_limits(axes: Any, layout: Dict[str, Any]) -> None:
    """The limits of the program's picture. What is drawn later into the axes may still widen them."""
    axes.set_xlim(*layout["x"][:2], auto=None)
    axes.set_ylim(*layout["y"][:2], auto=None)


def _set_scales(axes: Any, panel: Dict[str, Any]) -> None:
    if panel["logarithmic_x"]:
        axes.set_xscale("log")
    if panel["logarithmic_y"]:
        axes.set_yscale("log")


def _dress(axes: Any, font: float, family: str) -> None:
    """Tics and frame of axes on a page of our own."""
    from matplotlib.ticker import ScalarFormatter

    from ._artists import Tics

    stroke = font / USUAL_FONT
    axes.tick_params(which="major", labelsize=font, length=0.3 * font, width=0.8 * POINT * stroke, pad=0.3 * font)
    axes.tick_params(which="minor", length=0.18 * font, width=0.6 * POINT * stroke)
    for spine in axes.spines.values():
        spine.set_linewidth(0.8 * POINT * stroke)
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


def _label_axes(axes: Any, texts: Dict[str, Any], font: float, pad: float) -> None:
    axes.set_xlabel(lines_of(texts["x_label"]), fontsize=font, labelpad=pad)
    axes.set_ylabel(lines_of(texts["y_label"]), fontsize=font, labelpad=pad)


def _drawn_on_page(core: Any, panels: List[Any], page_of: Callable[..., Any]) -> Any:
    """Draws a figure on a page of its own, arranged as the program does. page_of: makes matplotlib's figure."""
    import matplotlib
    import numpy

    page, style = core.layout(), core.style
    font, width, height = page["font"], page["width"], page["height"]
    plain: Dict[str, Any] = {"figure.autolayout": False, "figure.constrained_layout.use": False}
    if style["font"]:
        plain["font.family"] = [style["font"], *matplotlib.rcParams["font.family"]]
    # Not within the context: the first figure loads the backend, which in notebooks sets parameters for good.
    figure = page_of(figsize=(width / PER_INCH, height / PER_INCH))
    with matplotlib.rc_context(plain):
        figure.set_layout_engine(None)
        if page["title"]:
            figure.suptitle(lines_of(page["title"]), x=0.5, y=page["title_top"] / height, va="top",
                            fontsize=1.1 * font)
        look = Look(font, max(map(dots_of, panels, page["panels"]), default=0))
        drawn = []
        for number, (panel, layout) in enumerate(zip(panels, page["panels"])):
            left, low, right, high = layout["frame"]
            if layout["y_power"] and not layout["title"]:  # the power of ten stands above
                high = min(high, page["title_low"] - 1.6 * font)
            axes = figure.add_axes([left / width, low / height, (right - left) / width, (high - low) / height])
            drawn.append(axes)
            _set_scales(axes, panel)
            draw_panel(axes, core, number, panel, look, layout["covering"])
            _set_limits(axes, layout)
            _dress(axes, font, style["font"])
            # Tics have a power of ten of their own: labels that were set later would not know it.
            _label_axes(axes, core.texts(number, right - left, high - low, font), font, 0.2 * font)
            axes.set_title(lines_of(layout["title"]), fontsize=font, pad=0.4 * font)
            note: Optional[_Notes] = None
            if layout["notes"]:
                x, y = layout["notes_at"]
                text = figure.text(x / width, y / height, "", fontsize=_graze.legend_font * font, ha="left", va="top",
                                   linespacing=1.25)
                room = max(right, width if page["panels"][-1] is layout else right) - x
                note = _Notes(panel, core.symbols, room, font, text)
                text.set_text(lines_of(layout["notes"]))
            samples = samples_of(axes, layout["legend"], look)
            legend = place_legend(axes, samples, layout["legend"], page, look, figure)
            _arranged_labels(axes, core, number, panel, font, note, legend)
            if not any(len(series["points"]) or len(series["cells"]) for series in panel["series"]):
                axes.text(0.5, 0.5, "no data", transform=axes.transAxes, ha="center", va="center", fontsize=font)
        if page["legend"] and drawn:
            place_legend(figure, samples_of(drawn[0], page["legend"], look), page["legend"], page, look, figure)
    return drawn[0] if len(drawn) == 1 else numpy.array(drawn)


def _arranged_labels(axes: Any, core: Any, number: int, panel: Dict[str, Any], font: float, note: Any,
                     legend: Any) -> None:
    if panel["labels"]:
        from ._artists import PointLabels

        PointLabels(axes, core, number, len(panel["labels"]), font, 0.5 * POINT * font / USUAL_FONT, note, legend).arrange()


def _drawn_into(core: Any, panels: List[Any], given: List[Any]) -> Any:
    """Draws a figure into axes that the user gave, one for each panel."""
    import numpy

    page = core.layout()
    dots = max(map(dots_of, panels, page["panels"]), default=0)
    for number, (axes, panel, layout) in enumerate(zip(given, panels, page["panels"])):
        before = axes.has_data()
        font = axes.xaxis.label.get_fontsize()
        look = Look(font, dots)
        _set_scales(axes, panel)
        points = PER_INCH / axes.figure.dpi
        box = axes.bbox
        if not before:
            _set_limits(axes, layout)
        covering = core.covering(number, box.width * points, box.height * points, layout["x"], layout["y"])
        draw_panel(axes, core, number, panel, look, covering)
        if not before:
            _set_limits(axes, layout)
        else:
            axes.autoscale_view()
        texts = core.texts(number, max(box.width * points, 1), max(box.height * points, 1), font)
        if not axes.get_xlabel():
            axes.set_xlabel(lines_of(texts["x_label"]))
        if not axes.get_ylabel():
            axes.set_ylabel(lines_of(texts["y_label"]))
        if not axes.get_title():
            words = [_graze.rich_words(core.title, core.symbols)] if core.title and len(panels) == 1 else texts["title"]
            axes.set_title(lines_of(words))
        entries = (page["legend"] if number == 0 else []) if page["legend"] else texts["legend"]
        legend = inner_legend(axes, panel, entries, look) if entries else axes.get_legend()
        text = axes.annotate("", (0, 0), xycoords="axes fraction", xytext=(0, -3.6 * font), textcoords="offset points",
                             ha="left", va="top", fontsize=_graze.legend_font * font, annotation_clip=False)
        note = _Notes(panel, core.symbols, box.width * points, font, text)
        note.tell()
        _arranged_labels(axes, core, number, panel, font, note, legend)
    return given[0] if len(given) == 1 else numpy.array(given)


def plane_axes(axes: Any) -> List[Any]:
    """Axes of matplotlib that a caller gave, one or any arrangement of several, as a list."""
    import numpy
    from matplotlib.axes import Axes

    given = list(numpy.atleast_1d(numpy.asarray(axes, dtype=object)).ravel())
    for one in given:
        if not isinstance(one, Axes) or one.name != "rectilinear":
            raise InputError(f"axes has an object of type {type(one).__name__}",
                             "give plane axes of matplotlib, as pyplot.subplots() returns them")
    if len(set(map(id, given))) != len(given):
        raise InputError("the same axes were given twice", "give one for each panel")
    return given


def checked_axes(axes: Any, panels: int) -> List[Any]:
    given = plane_axes(axes)
    if len(given) != panels:
        raise InputError(f"{len(given)} axes were given, and there {'is' if panels == 1 else 'are'} {panels} "
                         f"panel{'' if panels == 1 else 's'}", "give one for each panel, or none")
    return given


def draw(core: Any, axes: Any = None, panels: Optional[List[Any]] = None) -> Any:
    """Draws a figure of the library. axes: the one axes, or the sequence of as many as there are panels, to draw into;
    pyplot is not touched then. Without them a figure of pyplot is made, of the size and arrangement of the program's
    picture. panels: those of the figure, where they are known. Returns the axes: one, or an array of several.

    Raises InputError if there are not as many axes as panels."""
    panels = core.panels() if panels is None else panels
    if axes is not None:
        return _drawn_into(core, panels, checked_axes(axes, len(panels)))
    from matplotlib import pyplot

    return _drawn_on_page(core, panels, pyplot.figure)


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
        return draw(self._core, axes, self.panels)

    def __repr__(self) -> str:
        series = sum(not one["only_in_legend"] for panel in self.panels for one in panel["series"])
        return f"<Figure of {len(self.panels)} panel{'s' * (len(self.panels) != 1)} with {series} series>"

    def _repr_html_(self) -> str:
        return small_picture(lambda: self._core, repr(self))


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

    return numpy.atleast_1d(_drawn_on_page(core, core.panels(), page_of)).ravel()[0].figure


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
