"""`graze.layout`: what is drawn, measured and written, wafers of devices, and wrong uses."""

import copy
import json
import math
import pathlib
import pickle
import re
import struct

import numpy as np
import pytest

import graze

ROOT = pathlib.Path(__file__).parents[2]
DOCUMENTATION = (ROOT / "docs/layout.md").read_text()
MINE = re.search(r"```toml file=mine.toml\n(.*?)```", DOCUMENTATION, re.S).group(1)
# The whole design in little time.
QUICK = {"yield_": {"devices": 50}, "points": {"curve": 3, "plane": 3}, "trip": {"overshoots": [0.1]}, "wanted": None}


@pytest.fixture(scope="module")
def device():
    return graze.layout("mems-switch-device")


def area(corners):
    x, y = corners.T
    return abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def boundaries(stream):
    """(cell, layer, datatype, corners in um) of all polygons of a GDSII file, by an own reader."""
    at, cell, layer, kind, found = 0, "", 0, 0, []
    while at < len(stream):
        size, record = struct.unpack(">HH", stream[at:at + 4])
        data = stream[at + 4:at + size]
        if record == 0x0606:
            cell = data.rstrip(b"\0").decode()
        elif record == 0x0D02:
            layer = struct.unpack(">h", data)[0]
        elif record == 0x0E02:
            kind = struct.unpack(">h", data)[0]
        elif record == 0x1003 and len(data) > 8 * 3:
            numbers = np.array(struct.unpack(f">{len(data) // 4}i", data)).reshape(-1, 2) / 1000
            found.append((cell, layer, kind, numbers[:-1]))
        elif record == 0x0400:
            break
        at += size
    return found


def test_measures_of_the_documentation():
    block = re.search(r"```text output\n(DEVICE,gap.*?)```", DOCUMENTATION, re.S).group(1)
    drawing = graze.layout(text=MINE)
    rows = [line.split(",") for line in block.splitlines()]
    assert len(rows) == 8
    for i, (cell, what, value, unit) in enumerate(rows):
        table = drawing.table
        assert (table["cell"][i], table["what"][i], table["unit"][i]) == (cell, what, unit)
        assert f"{table['value'][i]:.12g}" == value
        assert drawing[what] == table["value"][i]
    assert drawing.name == "mine" and drawing.top == "DEVICE"


def test_areas_are_those_of_the_polygons(device):
    polygons = device.polygons()
    texts = graze.mask_layers()
    checked = 0
    for layer, shapes in polygons.items():
        what = f"layer {layer[0]}/{layer[1]}: {texts[layer]}"
        assert device[what] == pytest.approx(sum(map(area, shapes)), rel=1e-9)
        checked += 1
    assert checked >= 8
    assert device["mass"] == pytest.approx(sum(map(area, polygons[10, 0])), rel=1e-12)
    assert device["beams"] == 8


def test_masks_as_files(device, tmp_path):
    path = tmp_path / "device.gds"
    device.save(path)
    stream = path.read_bytes()
    assert stream == device.gds()
    found = boundaries(stream)
    assert {"DEVICE", "FLEXURE"} <= {cell for cell, *_ in found}
    one = boundaries(device.gds(1))
    assert {layer for _, layer, _, _ in one} == {1}
    drawn = sum(area(corners) for cell, layer, kind, corners in one if kind == 0)
    assert drawn == pytest.approx(sum(map(area, device.polygons(1)[1, 0])), rel=1e-9)
    # Mask 1 is mirrored from x to -x.
    seen, mirrored = device.polygons()[1, 0], device.polygons(1)[1, 0]
    assert min(shape[:, 0].min() for shape in seen) == pytest.approx(-max(shape[:, 0].max() for shape in mirrored))


def test_lumped_model(device):
    lumped = device.lumped
    assert lumped.frequency == pytest.approx(math.sqrt(lumped.stiffness / lumped.mass) / (2 * math.pi), rel=1e-14)
    assert lumped.damping_ratio == pytest.approx(lumped.damping / (2 * math.sqrt(lumped.stiffness * lumped.mass)))
    permittivity = 8.8541878128e-12
    assert lumped.pull_in == pytest.approx(math.sqrt(8 * lumped.stiffness * lumped.gap**3 /
                                                     (27 * permittivity * lumped.area)), rel=1e-12)
    assert device["model: natural frequency"] == pytest.approx(lumped.frequency, rel=1e-14)
    parameters = device.parameters
    assert set(parameters) == {"m", "f0", "zeta", "area", "d", "stop"}
    assert parameters["f0"] == pytest.approx(lumped.frequency / 1e3, rel=1e-12)
    assert parameters["stop"] == pytest.approx(lumped.stop * 1e6, rel=1e-12)
    assert device.device.parameters["zeta"] == parameters["zeta"]
    # Wider beams are stiffer, as the third power of the width after the etch (0.3 um off each edge).
    wider = graze.layout("mems-switch-device", set={"flexure_width": 7.7, "taper": 0}).lumped.stiffness
    narrow = graze.layout("mems-switch-device", set={"taper": 0}).lumped.stiffness
    assert wider / narrow == pytest.approx((7.1 / 6.4) ** 3, rel=0.03)


def test_numbers_can_be_replaced(device):
    other = graze.layout("mems-switch-device", set={"stop_gap": "7.5 um", "folds": 2})
    assert other["stop gap"] == 7.5 and other["beams"] == 16
    same = graze.layout("mems-switch-device", device={"stop_gap": 7.5, "folds": 2})
    assert same.gds(despite_rules=True) == other.gds(despite_rules=True)
    assert device["stop gap"] == 8.4
    alone = graze.layout(name="alone", device={"gap": 12, "stop_gap": "0.6*12"})
    assert alone["stop gap"] == pytest.approx(7.2)


def test_rules(device, tmp_path):
    assert device.holds and device.broken == [] and device.rules["holds"].all()
    broken = graze.layout("mems-switch-device", set={"gap": 5})
    assert not broken.holds and len(broken.broken) == (~broken.rules["holds"]).sum()
    assert "smallest_gap" in set(broken.rules.rows(~broken.rules["holds"])["rule"])
    for name in ("a.gds", "a.svg", "a.va", "a.toml", "a.md"):
        with pytest.raises(graze.InputError, match="gap"):
            broken.save(tmp_path / name)
    assert list(tmp_path.iterdir()) == []
    broken.save(tmp_path / "a.lyrdb")
    assert "smallest_gap" in (tmp_path / "a.lyrdb").read_text()
    broken.save(tmp_path / "a.gds", despite_rules=True)
    assert (tmp_path / "a.gds").stat().st_size > 1000


def test_other_files(device, tmp_path):
    for name, words in (("a.va", "module"), ("a.md", "#"), ("a.toml", "zeta"), ("a.svg", "<svg")):
        device.save(tmp_path / name)
        assert words in (tmp_path / name).read_text()
    device.save(tmp_path / "a.png", mask=2)
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    assert (tmp_path / "a.va").read_text() == device.verilog_a()
    # A design is not replaced by its own drawing.
    file = tmp_path / "mine.toml"
    file.write_text(MINE)
    with pytest.raises(graze.InputError, match="design too"):
        graze.layout(file).save(file)
    assert file.read_text() == MINE
    with pytest.raises(graze.InputError, match="ending"):
        device.save(tmp_path / "a.txt")


def test_pictures(device):
    axes = device.plot()
    assert len(axes.collections) == len(device.polygons())
    assert len(device.steps()) == 11 and len(device.plot_steps()) == 11
    text, slabs = device.steps()[-1]
    assert "silicon" in slabs["material"] and (slabs["right"] > slabs["left"]).all()
    assert "png" in device._repr_html_() and "all rules hold" in repr(device)


def test_wafer_drawing():
    wafer = graze.layout("mems-switch-device", wafer=True)
    assert wafer.top == "WAFER" and wafer.is_wafer
    angles = [wafer[f"direction of device {i}"] for i in range(1, 9)]
    assert np.allclose(np.diff(angles), 45)
    varied = graze.layout("mems-switch-device", wafer=True, wafer_={"vary": {"stop_gap": [8.2, 8.4]}})
    with pytest.raises(graze.InputError, match="differ"):
        varied.lumped
    assert len(set(varied.table["cell"])) == 3


def test_wafers_of_devices(tmp_path):
    drawing = graze.layout("mems-switch-device", **QUICK)
    wafers = drawing.wafers(2, seed=3)
    assert len(wafers.devices) == 16 and wafers.count == 2
    values = np.array([value if isinstance(value, float) else math.nan for value in wafers.devices["V"]])
    inside = (values >= 26.6) & (values <= 29.4)
    assert wafers["yield"] == pytest.approx(inside.mean(), abs=1e-12)
    assert wafers["devices"] == 16
    assert wafers.failed == 0 or wafers.problems
    again = drawing.wafers(2, seed=3, threads=3)
    assert again.report == wafers.report
    assert drawing.wafers(1, seed=4).devices != drawing.wafers(1, seed=3).devices
    written = wafers.save(tmp_path / "wafers")
    assert [pathlib.Path(path).name for path in written] == ["wafers.csv", "devices.csv", "report.json", "map.svg", "map.png"]
    assert json.loads(pathlib.Path(written[2]).read_text())["seed"] == 3
    assert len(wafers.plot()) == 2 and "yield" in wafers._repr_html_()
    copied = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(wafers))))
    assert (copied.report, copied.devices, dict(copied)) == (wafers.report, wafers.devices, dict(wafers))
    assert len(copied.plot()) == 2
    with pytest.raises(graze.Interrupted):
        drawing.wafers(1000, progress=lambda text: False)


def test_drawing_of_a_designed_device(tmp_path):
    found = graze.design("mems-switch-device", **QUICK)
    drawing = graze.layout("mems-switch-device", from_design=found, **QUICK)
    assert found.layout().gds() == drawing.gds()
    for name, value in drawing.parameters.items():
        assert value == pytest.approx(found.device.parameters[name], rel=2e-3)
    compared = drawing.compare()
    table = compared.table
    assert compared.met == bool(compared.met)
    row = table["quantity"].index("trip_value")
    assert table["designed"][row] == pytest.approx(found.trip_value, rel=1e-9)
    assert table["drawn"][row] == pytest.approx(found.trip_value, rel=2e-3)
    found.save(tmp_path / "found", pictures=False)
    same = graze.layout("mems-switch-device", from_design=tmp_path / "found", **QUICK)
    assert same.gds(despite_rules=True) == drawing.gds(despite_rules=True)
    with pytest.raises(graze.InputError):
        graze.layout("mems-switch-device", from_design=tmp_path)  # a folder without a device
    with pytest.raises(graze.InputError, match="from_design"):
        graze.layout("mems-switch-device").compare()


@pytest.mark.parametrize("given, words", [
    (dict(design="mems-switch-devise"), "mems-switch-device"),
    (dict(design="absent.toml"), "cannot be read"),
    (dict(design="mems-switch-device", set={"flexure_length": 6000}), "flexure_length"),
    (dict(design="mems-switch-device", set={"gapp": 3}), "gap"),
    (dict(design="mems-switch-device", set={"gap": "3 V"}), "gap"),
    (dict(design="mems-switch-device", set={"gap": "wide"}), "wide"),
    (dict(design="mems-switch-device", set={"gap": -1}), "gap"),
    (dict(design="mems-switch-device", set={"gap": float("nan")}), "gap"),
    (dict(design="mems-switch-device", set={"gap": [3]}), "gap"),
    (dict(design="mems-switch-device", set={3: 3}), "text"),
    (dict(design="mems-switch-device", set=3), "dict"),
    (dict(design="mems-switch-device", device={"colour": 3}), "colour"),
    (dict(design="mems-switch-device", from_design="absent"), "absent"),
    (dict(design="mems-switch-device", from_design=3), "from_design"),
    (dict(design="mems-switch"), "device"),
    (dict(name="x"), "device"),
    (dict(text="name ="), "TOML"),
    (dict(design="mems-switch-device", wafer=True, wafer_={"devices": 1000}), ""),
])
def test_wrong_uses(given, words):
    with pytest.raises(graze.InputError, match=words):
        graze.layout(**given)


def test_wrong_numbers(device, tmp_path):
    for wrong in (lambda: device.gds(3), lambda: device.polygons(mask=True), lambda: device.wafers(0),
                  lambda: device.wafers(1.5), lambda: device.wafers(1, seed=-1), lambda: device.wafers(1, threads=0),
                  lambda: device.save(3), lambda: device.save(tmp_path)):
        with pytest.raises(graze.InputError):
            wrong()
    with pytest.raises(KeyError):
        device["nothing"]


def test_layouts_can_be_copied_and_pickled(device):
    changed = graze.layout("mems-switch-device", set={"gap": 14})
    for layout in (device, changed):
        for made in (pickle.loads(pickle.dumps(layout)), copy.deepcopy(layout), copy.copy(layout)):
            assert dict(made) == dict(layout) and made.rules == layout.rules and made.gds() == layout.gds()
    assert changed["gap"] != device["gap"]


def test_a_layout_is_a_mapping_of_its_measures(device):
    assert len(device) == len(set(device)) and "gap" in device and device.get("nothing") is None
    assert dict(device)["gap"] == device["gap"]
