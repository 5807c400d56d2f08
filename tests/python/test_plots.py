"""Pictures: what is drawn is the library's data, where the program draws it, and pyplot is left alone."""

import base64
import io
import pathlib
import pickle
import re
import subprocess

import matplotlib

matplotlib.use("Agg")

import numpy
import pytest
from matplotlib import pyplot
from matplotlib.collections import PathCollection, PolyCollection

import graze
from graze import _graze, _looks, _multipliers, _plot

PROGRAM = pathlib.Path(_graze.__file__).parents[2] / "bin" / "graze"
PER_INCH = 72


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    pyplot.close("all")


@pytest.fixture(scope="module")
def oscillator():
    return graze.Model.shipped("impact-oscillator", omega=2.8)


@pytest.fixture(scope="module")
def branch(oscillator):
    return graze.follow(oscillator, omega=(2, 3.2))


@pytest.fixture(scope="module")
def doubled(branch):
    return branch["GR1"].switch()


@pytest.fixture(scope="module")
def sweep(oscillator):
    return graze.sweep(oscillator, vary={"omega": (2.4, 3.0, 31)}, direction="both", cycles=60)


@pytest.fixture(scope="module")
def basin(oscillator):
    return graze.basin(oscillator, vary={"x": (-1, 0.1, 12), "v": (-1, 1, 11)}, cycles=60)


@pytest.fixture(scope="module")
def switch(tmp_path_factory):
    return graze.run_study("mems-switch", output=tmp_path_factory.mktemp("studies") / "switch")


@pytest.fixture(scope="module")
def shaker(tmp_path_factory):
    return graze.run_study("ball-and-shaker", output=tmp_path_factory.mktemp("studies") / "shaker")


def lines_of(axes):
    """The lines that have points: the others are samples for legends."""
    return [line for line in axes.lines if len(line.get_xdata())]


def drawn_symbols(axes):
    return [line for line in lines_of(axes) if line.get_marker() not in ("None", "none", None, "")]


def as_set(points):
    return {(float(x), float(y)) for x, y in points}


def require_same_data(axes, panel):
    """Every series of the library is drawn, with all its points, in its colour."""
    import matplotlib.colors

    lines = lines_of(axes)
    for series in panel["series"]:
        if series["only_in_legend"]:
            continue
        if series["style"] == "cells":
            boxes = {tuple(path.get_extents().extents) for one in axes.collections if isinstance(one, PolyCollection)
                     for path in one.get_paths()}
            assert {(left, low, right, high) for left, right, low, high in series["cells"]} <= boxes
            continue
        points = series["points"]
        if not len(points):
            continue
        if series["style"] == "dots":
            colour = matplotlib.colors.to_rgba(series["colour"])
            drawn = set()
            for one in axes.collections:
                if isinstance(one, PathCollection):
                    colours = numpy.broadcast_to(one.get_facecolors(), (len(one.get_offsets()), 4))
                    chosen = numpy.isclose(colours, colour).all(axis=1)
                    drawn |= as_set(one.get_offsets()[chosen])
            assert as_set(points) <= drawn
            continue
        finite = points[numpy.isfinite(points).all(axis=1)]
        same = [line for line in lines if matplotlib.colors.same_color(line.get_color(), series["colour"])]
        assert any(as_set(finite) <= as_set(line.get_xydata()) for line in same) or \
            as_set(finite) <= set().union(*(as_set(line.get_xydata()) for line in same))
    assert sum(len(line.get_xdata()) == 2 and line.get_xdata()[0] == line.get_xdata()[1] and line.get_linewidth() == 0.5
               for line in axes.lines) >= len(panel["marks"])


def label_boxes(axes):
    renderer = axes.figure.canvas.get_renderer()
    return [matplotlib.text.Text.get_window_extent(text, renderer)
            for text in axes.texts if text.get_visible() and text.get_text()]


def require_apart(axes):
    """No two labels overlap, and none leaves its axes."""
    axes.figure.canvas.draw()
    frame = axes.get_window_extent()
    boxes = label_boxes(axes)
    for number, one in enumerate(boxes):
        assert frame.x0 - 1 <= one.x0 and one.x1 <= frame.x1 + 1 and frame.y0 - 1 <= one.y0 and one.y1 <= frame.y1 + 1
        for other in boxes[number + 1:]:
            assert not one.overlaps(other), (one, other)
    return boxes


def require_inside_page(figure):
    """Nothing is cut by the edge of the page, and axes, legends and notes do not overlap."""
    renderer = figure.canvas.get_renderer()
    page = figure.bbox
    boxes = []
    for axes in figure.axes:
        boxes.append(("axes", axes.get_tightbbox(renderer, bbox_extra_artists=[])))
        if axes.get_legend() is not None:
            boxes.append(("legend", axes.get_legend().get_window_extent(renderer)))
    boxes += [("legend", legend.get_window_extent(renderer)) for legend in figure.legends]
    boxes += [("text", text.get_window_extent(renderer)) for text in figure.texts if text.get_text()]
    for kind, box in boxes:
        assert page.x0 - 1 <= box.x0 and box.x1 <= page.x1 + 1, (kind, box)
        assert page.y0 - 1 <= box.y0 and box.y1 <= page.y1 + 1, (kind, box)
    for number, (kind, box) in enumerate(boxes):
        for other, another in boxes[number + 1:]:
            beside = box.x1 < another.x0 + 2 or another.x1 < box.x0 + 2
            apart = beside or box.y1 < another.y0 + 2 or another.y1 < box.y0 + 2
            assert apart, (kind, box, other, another)


# Data


def test_a_branch_is_drawn_as_in_its_table(branch):
    axes = branch.plot(y="period")
    points = branch.points
    drawn = set().union(*(as_set(line.get_xydata()) for line in lines_of(axes)))
    assert as_set(zip(points["omega"], points["period"])) <= drawn
    symbols = set().union(*(as_set(line.get_xydata()) for line in drawn_symbols(axes)))
    assert symbols == {(point.parameter, point.period) for point in branch if point.type != "EP"}
    assert [text.get_text() for text in axes.texts if text.get_visible()] != []
    assert {text.get_text() for text in axes.texts if text.get_visible()} == \
        {point.label for point in branch if point.type != "EP"}


def test_stable_and_unstable_parts_are_told_apart(branch):
    axes = branch.plot(y="period")
    stable = dict(zip(branch.points["omega"], branch.points["stable"]))
    special = {point.parameter for point in branch}
    for line in lines_of(axes):
        if line in drawn_symbols(axes):
            continue
        looks = {bool(stable[x]) for x in line.get_xdata() if x in stable and x not in special}
        assert len(looks) <= 1
        for look in looks:
            assert (line.get_linestyle() == "-") == look
    assert [text.get_text() for text in axes.get_legend().get_texts()] == \
        ["stable", "unstable", "SN: fold", "PD: flip", "GR: grazing"]


def test_every_picture_of_quick_studies(switch, shaker):
    for study in (switch, shaker):
        assert study.pictures
        for name in study.pictures:
            data = study.figure(name)
            drawn = numpy.atleast_1d(study.plot(name))
            assert len(drawn) == len(data.panels)
            for axes, panel in zip(drawn, data.panels):
                require_same_data(axes, panel)
                require_apart(axes)
                assert axes.get_xscale() == ("log" if panel["logarithmic_x"] else "linear")
                assert axes.get_yscale() == ("log" if panel["logarithmic_y"] else "linear")
            require_inside_page(drawn[0].figure)
            pyplot.close("all")


def test_pictures_have_the_arrangement_of_the_program(switch):
    core = switch.figure("branches")._core
    page = core.layout()
    first, second = switch.plot("branches")
    size = first.figure.get_size_inches() * PER_INCH
    assert tuple(size) == pytest.approx((page["width"], page["height"]))
    for axes, panel in zip((first, second), page["panels"]):
        box = axes.get_position().extents * numpy.tile(size, 2)
        assert tuple(box) == pytest.approx(panel["frame"])
        assert axes.get_xlim() == pytest.approx(panel["x"][:2])
        assert axes.get_ylim() == pytest.approx(panel["y"][:2])
    legend, = first.figure.legends  # one for both panels
    assert [text.get_text() for text in legend.get_texts()][:2] == ["no impact", "unstable"]  # by columns
    assert {text.get_text() for text in legend.get_texts()} == {entry["title"] for entry in page["legend"]}


@pytest.mark.skipif(not PROGRAM.exists(), reason="the program is not built beside the module")
def test_labels_are_where_the_program_draws_them(switch, tmp_path):
    subprocess.run([PROGRAM, "plot", switch._store.path, "--run", "touches_frequency", "folds_frequency", "--output",
                    tmp_path / "p.png", "--data", tmp_path / "p.gp"], check=True, capture_output=True)
    script = (tmp_path / "p.gp").read_text()
    told = {}
    for text, x, y in re.findall(r'set label "([^"]*)" at screen ([0-9.]+),([0-9.]+) center .*front', script):
        told[text] = (float(x), float(y))
    axes = switch["touches_frequency"].plot(also=[switch["folds_frequency"]])
    axes.figure.canvas.draw()
    shown = {text.get_text(): axes.figure.transFigure.inverted().transform(
        axes.transData.transform(text.xy) + numpy.array(text.get_position()) * axes.figure.dpi / PER_INCH)
        for text in axes.texts if text.get_visible()}
    assert set(shown) == set(told) and len(shown) > 5
    for text, place in shown.items():
        assert tuple(place) == pytest.approx(told[text], abs=2e-5)


def test_lines_are_smoothed_through_their_points():
    points = numpy.array([[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]])
    dashes, counts = _graze.dashes(points * 100, 4.0, 2.0, [0.0, 0.0, 200.0, 100.0])
    assert len(counts) > 20 and counts.sum() == len(dashes)
    lengths = [numpy.ptp(part[:, 0]) for part in numpy.split(dashes, numpy.cumsum(counts)[:-1])]
    assert max(lengths) == pytest.approx(4.0)
    # Positions depend on the place only: the way back has the same dashes.
    back, _ = _graze.dashes(points[::-1] * 100, 4.0, 2.0, [0.0, 0.0, 200.0, 100.0])
    assert numpy.sort(back, axis=0) == pytest.approx(numpy.sort(dashes, axis=0), abs=1e-9)


def test_a_sweep(sweep):
    chosen = sweep.plot(y=["x"], directions=["up"])
    axes = sweep.plot(y=["x", "v"])
    assert numpy.shape(chosen) == () and len(axes) == 4
    data = sweep.figure(y=["x", "v"])
    for one, panel in zip(axes, data.panels):
        require_same_data(one, panel)
    drawn = sum(len(series["points"]) for series in sweep.figure(y="x").panels[0]["series"])
    up = numpy.array([way == "up" for way in sweep.samples["direction"]])
    assert drawn == up.sum()


def test_the_data_of_a_picture(branch):
    figure = branch.figure(y="period", title="one")
    assert isinstance(figure, graze.Figure) and figure.title == "one" and "1 panel " in repr(figure)
    panel, = figure.panels
    assert (panel["x_label"], panel["y_label"]) == ("omega", "period")
    assert {label["text"] for label in panel["labels"]} == {"SN1", "GR1", "PD1", "GR2"}
    axes = pyplot.figure().add_subplot()
    assert figure.plot(axes=axes) is axes
    assert axes.get_title() == "one"
    assert "base64" in figure._repr_html_()


def test_a_basin(basin):
    axes = basin.plot()
    panel, = basin.figure().panels
    require_same_data(axes, panel)
    cells = [one for one in axes.collections if isinstance(one, PolyCollection)]
    boxes = [path.get_extents() for one in cells for path in one.get_paths()]
    step = (1.1 / 11, 2 / 10)  # each state has a cell around it
    assert sum(box.width * box.height for box in boxes) == pytest.approx(12 * step[0] * 11 * step[1])
    titles = [text.get_text() for text in axes.get_legend().get_texts()]
    assert sum(int(re.search(r"\((\d+)\)", title)[1]) for title in titles if "(" in title) == 12 * 11
    assert basin.plot(kind="map").get_legend() is not None


def test_a_motion_with_its_contacts(oscillator):
    motion = graze.simulate(oscillator, periods=6)
    axes = motion.plot(["x", "v"], [("x", "v")])
    assert len(axes) == 3
    contacts = motion.contacts
    marked = set().union(*(as_set(line.get_xydata()) for line in drawn_symbols(axes[1])))
    assert len(contacts) > 0
    assert marked == as_set(zip(contacts["x"], contacts["v"])) | as_set(zip(contacts["x_after"], contacts["v_after"]))
    assert "contact" in [text.get_text() for text in axes[0].figure.legends[0].get_texts()]
    assert [panel["x_label"] for panel in motion.figure(["x"]).panels][0] == "t"


def test_an_orbit(branch):
    point = branch["PD1"]
    axes = point.plot()
    drawn = numpy.concatenate([line.get_xydata() for line in lines_of(axes)])
    motion = point.motion()
    assert numpy.nanmin(drawn[:, 0]) == pytest.approx(motion["x"].min(), rel=1e-3)
    assert numpy.nanmax(drawn[:, 1]) == pytest.approx(motion["v"].max(), rel=1e-2)
    histories = point.plot(kind="history")
    assert len(histories) == 2
    assert histories[0].get_xlim()[1] > point.period


def test_multipliers(branch):
    axes = branch["PD1"].plot_multipliers()
    drawn = numpy.concatenate([line.get_xydata() for line in drawn_symbols(axes)])
    told = branch["PD1"].multipliers
    assert as_set(drawn) == {(one.real, one.imag) for one in told}
    circle = lines_of(axes)[0].get_xydata()
    assert numpy.hypot(*circle.T) == pytest.approx(numpy.ones(len(circle)))
    far = _multipliers.draw_multipliers([0.5, -140.0, 3j, float("nan")], "far")
    assert [text.get_text() for text in far.texts] == ["−140"]
    shown = numpy.concatenate([line.get_xydata() for line in drawn_symbols(far)])
    assert numpy.hypot(*shown.T).max() == pytest.approx(3)
    given = pyplot.figure().add_subplot()
    assert branch["PD1"].plot_multipliers(axes=given) is given


# Several runs


def test_several_branches(branch, doubled):
    axes = branch.plot(also=[doubled], y="period")
    colours = {line.get_color() for line in lines_of(axes)}
    assert {"#0072b2", "#d55e00"} <= colours
    titles = [text.get_text() for text in axes.get_legend().get_texts()]
    assert branch.name in titles and doubled.name in titles
    drawn = set().union(*(as_set(line.get_xydata()) for line in lines_of(axes)))
    for run in (branch, doubled):
        assert as_set(zip(run.points["omega"], run.points["period"])) <= drawn
    require_apart(axes)
    assert lines_of(branch.plot(also=doubled, y="period"))


def test_branches_of_other_results(oscillator, branch):
    other = graze.follow(graze.Model.shipped("impact-oscillator", omega=2.8, e=0.79), omega=(2, 3.2))
    axes = branch.plot(also=other, y="period")
    colours = {branch: "#0072b2", other: "#d55e00"}
    for run, colour in colours.items():
        drawn = set().union(*(as_set(line.get_xydata()) for line in lines_of(axes) if line.get_color() == colour))
        assert as_set(zip(run.points["omega"], run.points["period"])) <= drawn


def test_runs_that_cannot_be_drawn_together_are_told(branch, sweep):
    for words in ({"also": [sweep]}, {"also": ["continue1"]}, {"over": [3]}):
        with pytest.raises(graze.InputError) as told:
            branch.plot(**words)
        assert told.value.file in ("plot()", "plot(), " + next(iter(words)))


# Axes of the user


def test_axes_of_the_user_and_no_pyplot(branch, doubled):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5, 6), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(2, 1)
    drawn = branch.plot(also=[doubled], y=["period", "multiplier"], axes=grid)
    assert list(drawn) == list(grid)
    assert pyplot.get_fignums() == []
    figure.canvas.draw()
    for axes, panel in zip(grid, branch.figure(also=[doubled], y=["period", "multiplier"]).panels):
        require_same_data(axes, panel)
        boxes = require_apart(axes)
        assert boxes
        if axes.get_legend() is not None:
            legend = axes.get_legend().get_window_extent()
            assert not any(legend.overlaps(box) for box in boxes)
    assert grid[0].get_xlabel() == "angular frequency of the force" and grid[0].get_ylabel() == "period"


def test_labels_stay_apart_when_limits_and_size_change(branch, doubled):
    axes = branch.plot(also=[doubled], y="period")
    before = [text.get_position() for text in axes.texts if text.get_visible()]
    axes.set_xlim(2.6, 2.68)
    axes.set_ylim(4.7, 4.85)
    shown = require_apart(axes)
    assert shown
    assert [text.get_position() for text in axes.texts if text.get_visible()] != before or len(shown) != len(before)
    axes.figure.set_size_inches(2.5, 2.5)
    require_apart(axes)


def test_what_was_in_the_axes_stays(branch):
    axes = pyplot.figure().add_subplot()
    axes.plot([1, 5], [4.5, 4.6], color="black", label="measured")
    axes.set_xlabel("mine")
    branch.plot(y="period", axes=axes)
    assert axes.get_xlabel() == "mine" and axes.get_ylabel() == "period"
    assert axes.get_xlim()[0] <= 1 and axes.get_xlim()[1] >= 5
    assert "measured" in [text.get_text() for text in axes.get_legend().get_texts()]
    fresh = branch.plot(y="period", axes=pyplot.figure().add_subplot())
    limits = fresh.get_xlim()
    fresh.plot([limits[1] + 1], [4.5])  # later data widen the limits
    assert fresh.get_xlim()[1] > limits[1]


def test_wrong_axes_are_told(branch):
    axes = pyplot.figure().subplots(1, 3)
    for wrong in (axes, [axes[0], axes[0]], "axes", [axes[0], 3], pyplot.figure().add_subplot(projection="polar")):
        with pytest.raises(graze.InputError):
            branch.plot(y=["period", "multiplier"], axes=wrong)
    with pytest.raises(graze.InputError) as told:
        branch.plot(y=["period", "multiplier"], axes=axes)
    assert "3 axes were given, and there are 2 panels" in told.value.problem
    assert not any(axes[0].lines)


def test_wrong_keys_are_told(branch, sweep, switch):
    for words, key in (({"kindd": "branch"}, "kindd"), ({"kind": "brunch"}, "kind"), ({"x_range": "wide"}, "x_range"),
                       ({"format": "pdf"}, "format"), ({"run": "other"}, "run"), ({"size": -3}, "size")):
        with pytest.raises(graze.InputError) as told:
            branch.plot(**words)
        assert told.value.file == f"plot(), {key}", told.value
    with pytest.raises(graze.InputError) as told:
        sweep.plot(y=["nothing"])
    assert told.value.file.startswith("plot()") and "nothing" in told.value.problem
    with pytest.raises(graze.InputError) as told:
        switch.plot("fig-9")
    assert "branches" in told.value.remedy


# Looks


def test_grey_and_sizes(branch):
    axes = branch.plot(y="period", grey=True, size=85, font=7)
    assert {line.get_color() for line in lines_of(axes)} <= {"#000000", "#b0b0b0", "#808080"}
    assert axes.figure.get_size_inches()[0] * 25.4 == pytest.approx(85)
    assert axes.xaxis.label.get_fontsize() == 7


def test_names_and_units_are_written_as_symbols(shaker):
    axes = numpy.atleast_1d(shaker.plot("fig-4-4"))[0]
    assert axes.get_xlabel() == "velocity jump at one contact (mm/s)"
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert legend[0].startswith(r"$\mathit{f}$ = 6 Hz: slope")
    assert _looks.markup(_graze.rich_unit("m/s^2")) == r"m/s$^{\mathrm{2}}$"
    assert _looks.markup(_graze.rich_name("x_nd")) == r"$\mathit{x}_{\mathrm{nd}}$"
    assert _looks.markup([("50 $", "upright")]) == r"50 \$"


def test_a_label_never_knows_a_power_that_the_tics_have(oscillator):
    axes = graze.simulate(oscillator, periods=2).plot(["1e-7*x"])[0]
    axes.figure.canvas.draw()
    assert "10" in axes.yaxis.get_offset_text().get_text()
    assert "10" not in axes.get_ylabel()
    box = axes.yaxis.get_offset_text().get_window_extent(axes.figure.canvas.get_renderer())
    assert box.y1 <= axes.figure.bbox.y1 + 1


def test_figures_can_be_pickled(branch):
    axes = branch.plot(y="period")
    again = pickle.loads(pickle.dumps(axes.figure)).axes[0]
    assert [text.get_text() for text in again.texts] == [text.get_text() for text in axes.texts]
    assert numpy.array_equal(again.lines[0].get_xydata(), axes.lines[0].get_xydata())
    for ending in ("pdf", "svg"):
        file = io.BytesIO()
        axes.figure.savefig(file, format=ending)
        assert file.tell() > 5000


# Notebooks


def test_notebooks_show_small_pictures(oscillator, branch, sweep, basin, switch):
    shown = [branch, sweep, basin, branch["GR1"], graze.simulate(oscillator, periods=5), switch["trip"]]
    for one in shown:
        text = one._repr_html_()
        assert len(text) < 60_000
        picture = base64.b64decode(re.search('base64,([^"]*)"', text)[1])
        assert picture.startswith(b"\x89PNG")
    assert pyplot.get_fignums() == []


def test_notebooks_never_raise():
    def broken():
        raise RuntimeError("no picture")

    assert _plot.small_picture(broken, "a < b") == "<p>a &lt; b</p>"
    assert _plot.small_picture(lambda: None, "none") == "<p>none</p>"
    assert pyplot.get_fignums() == []


def test_long_motions_are_not_computed_again(oscillator):
    motion = graze.simulate(oscillator, periods=5000, samples=10)
    assert motion.steps > 20_000
    assert "img" not in motion._repr_html_()


def test_dark_styles_and_style_sheets(branch):
    with pyplot.style.context("dark_background"):
        axes = branch.plot(y="period")
        axes.figure.canvas.draw()
        labels = {text.get_color() for text in axes.texts if text.get_visible()}
        assert labels == {"#ffffff"}
    for style in ("ggplot", "classic", "seaborn-v0_8-paper"):
        with pyplot.style.context(style):
            require_apart(branch.plot(y="period"))


def test_panels_are_made_once(branch, monkeypatch):
    calls, panels = [], _graze.Figure.panels
    monkeypatch.setattr(_graze.Figure, "panels", lambda self: calls.append(1) or panels(self))
    branch.plot(y=["max_x", "period"])
    assert len(calls) == 1
    figure = branch.figure(y="period")
    assert len(calls) == 2
    figure.plot()
    figure.plot(axes=pyplot.figure().add_subplot())
    assert len(calls) == 2
