"""Run by KLayout: merges what graze has drawn, measures areas and gaps on the merged polygons, and compares them with
what graze says. Lengths are exact to the nanometre; so are areas, but for those of devices that are turned on a wafer,
whose corners are rounded when they are put into one cell.
"""
import csv
import glob
import json
import os
import re
import sys
import traceback

import pya

wrong = []
boxes = {}


def table_of(path):
    with open(path, newline="") as rows:
        return list(csv.DictReader(rows))


class Drawing:
    def __init__(self, name):
        self.name = name
        self.layout = pya.Layout()
        self.layout.read(name + ".gds")
        self.rows = table_of(name + ".csv")
        tops = [cell.name for cell in self.layout.top_cells()]
        self.is_wafer = "WAFER" in tops
        self.expect(sorted(tops) == sorted(["WAFER" if self.is_wafer else "DEVICE", "MASK_1", "MASK_2"]), f"tops {tops}")
        self.expect(self.layout.dbu == 0.001, "unit")
        self.top = self.layout.cell("WAFER" if self.is_wafer else "DEVICE")

    def expect(self, holds, what):
        if not holds:
            wrong.append(f"{self.name}: {what}")

    def equal(self, one, other, what, tolerance=0.0):
        self.expect(one == one and abs(one - other) <= tolerance, f"{what}: {one} in KLayout, {other} in graze")

    def said(self, what, cell="DEVICE"):
        return [float(row["value"]) for row in self.rows if row["cell"] == cell and row["what"] == what][0]

    def nanometres(self, what, cell):
        return round(1000 * self.said(what, cell))

    def region(self, layer, datatype, cell=None):
        index = self.layout.find_layer(layer, datatype)
        if index is None:
            return pya.Region()
        region = pya.Region((cell or self.top).begin_shapes_rec(index))
        region.merged_semantics = False
        return region

    def check_layers(self):
        for row in self.rows:
            if not row["what"].startswith("layer "):
                continue
            layer, datatype = map(int, row["what"].split(":")[0][6:].split("/"))
            raw = self.region(layer, datatype)
            area, merged = raw.area() * 1e-6, raw.merged().area() * 1e-6
            said = float(row["value"])
            # Turned by no right angle, each corner moves by half a nanometre at most, along the polygon's perimeter.
            rounding = raw.perimeter() * 1e-3 * 1e-3 if self.is_wafer else 0
            close = rounding + 1e-12 * said
            self.equal(area, said, f"area of {layer}/{datatype}", close)
            self.equal(merged, said, f"merged area of {layer}/{datatype}", close)
            self.expect(raw.strange_polygon_check().is_empty(), f"a strange polygon on {layer}/{datatype}")
            self.expect(not any(polygon.holes() for polygon in raw.each()), f"a hole on {layer}/{datatype}")
            box = raw.bbox()
            boxes.setdefault(self.name, {})[f"{layer}/{datatype}"] = [box.left, box.bottom, box.right, box.top]
            merged_region = raw.merged()
            self.expect(merged_region.corners(-179.0, -91.0).is_empty(), f"an acute corner on {layer}/{datatype}")
            self.expect(merged_region.corners(91.0, 179.0).is_empty(), f"an acute corner on {layer}/{datatype}")
            if datatype < 3 and layer < 3:
                projection = pya.Region.Projection
                # Where corners are rounded, no crack of some nanometres may open between polygons that touch. Right angles
                # that are rounded to a little less are no narrow places.
                limit = 20
                self.expect(merged_region.space_check(limit, False, projection, 80).is_empty(), f"a crack on {layer}/{datatype}")
                self.expect(merged_region.width_check(limit, False, projection, 80).is_empty(), f"a sliver on {layer}/{datatype}")
            if not self.is_wafer:
                self.expect(raw.non_rectilinear().is_empty(), f"an oblique edge on {layer}/{datatype}")

    @staticmethod
    def distance(pair):
        """Of two parallel edges."""
        return pair.first.distance_abs(pair.second.p1)

    def nearest(self, pairs):
        found = [self.distance(pair) for pair in (pairs if isinstance(pairs, list) else pairs.each())]
        return min(found) if found else float("nan")

    def check_masks(self):
        """Mask 1 is the mirrored one; both have nothing but their layers."""
        mirrored = self.region(1, 0, self.layout.cell("MASK_1")).transformed(pya.Trans(pya.Trans.M90))
        front = self.region(1, 0)
        self.expect((mirrored.merged() ^ front.merged()).sized(-2).is_empty(), "mask 1 is not the mirror image")
        second = self.region(2, 0, self.layout.cell("MASK_2"))
        self.expect((second.merged() ^ self.region(2, 0).merged()).is_empty(), "mask 2 is not the drawing")
        for name, mask in (("MASK_1", 1), ("MASK_2", 2)):
            cell = self.layout.cell(name)
            for index in self.layout.layer_indexes():
                info = self.layout.get_info(index)
                self.expect(info.layer == mask or cell.bbox(index).empty(), f"{name} has {info}")

    def check_device(self, name):
        """What stays between the etched parts is what graze says it is."""
        cell = self.layout.cell(name)
        at = lambda layer, datatype: self.region(layer, datatype, cell).merged()
        etched, chamber, mass, beams = at(2, 0), at(1, 0), at(10, 0), at(10, 1)
        trusses, electrode, stops, die, base = at(10, 2), at(11, 0), at(12, 0), at(20, 0), at(11, 1)
        gap, stop_gap = self.nanometres("gap", name), self.nanometres("stop gap", name)
        beam = self.nanometres("beam width", name)
        projection = pya.Region.Projection
        both = electrode.separation_check(mass, gap + 1, False, projection)
        self.equal(self.nearest(both), gap, "gap")
        self.expect(electrode.separation_check(mass, gap, False, projection).is_empty(), "electrodes nearer than the gap")
        # All of the electrode's face that is so near faces the mass.
        facing = sum(pair.first.length() for pair in both.each() if self.distance(pair) == gap)
        self.equal(facing, self.nanometres("facing length", name), "facing length")
        self.equal(self.nearest(mass.separation_check(stops, stop_gap + 1, False, projection)), stop_gap, "stop gap")
        self.equal(self.nearest(beams.width_check(beam + 1, False, projection)), beam, "beam width")
        # From mask 2 alone: two pieces of silicon, the electrode and all else.
        stays = (die - etched).merged()
        self.equal(stays.count(), 2, "pieces of silicon")
        island = stays.not_interacting(die.edges())
        self.expect((island ^ electrode).is_empty(), "the island is not the electrode")
        moving = mass + beams + trusses
        self.expect((moving & etched).is_empty(), "something of the mass is etched")
        self.expect((stops & etched).is_empty(), "something of a stop is etched")
        self.expect(moving.merged().count() == 1, "the mass and its flexures are not one piece")
        self.expect((moving.merged() - chamber).is_empty(), "the mass lies beyond the chamber")
        self.expect((etched - chamber).is_empty(), "something is etched through beyond the chamber")
        self.expect((base - electrode).is_empty() and (base & chamber).is_empty(), "the base")
        # What is suspended above the chamber and neither mass nor electrode hangs on the frame.
        frame = (stays - electrode - moving.merged()).merged()
        self.expect(frame.count() == 1, "the frame is not one piece")
        self.expect(frame.interacting(stops).count() == 1, "the stops do not stand on the frame")
        self.expect(beams.interacting(frame).count() == 4, "four beams hang on the frame")
        least = min(gap, stop_gap, self.nanometres("beam spacing", name), beam)
        self.expect(self.no_sliver(etched, least) and self.no_sliver(chamber, least), "a sliver")

    def check_rules(self):
        """The worst of each rule that graze tells, found again on the merged masks."""
        worst = {}
        with open(self.name + ".rules") as lines:
            for rule, value in re.findall(r"rule (\w+) is ([-+.e0-9]+) um", lines.read()):
                if rule not in ("smallest_etched_line", "smallest_etched_gap", "free_way"):  # not of the masks alone
                    worst.setdefault(rule, round(1000 * float(value)))
        self.expect(sorted(worst) == ["chamber_overlap", "smallest_gap", "smallest_line", "undercut"], f"rules {worst}")
        masks = [sum((self.region(mask, part) for part in range(3)), pya.Region()).merged() for mask in (1, 2)]
        parts = [self.region(10, part).merged() for part in range(3)]
        chamber, electrode, base = masks[0], self.region(11, 0).merged(), self.region(11, 1).merged()
        projection = pya.Region.Projection

        def least(rule, checks):
            """Digits of messages are six: the last may be rounded."""
            said = worst[rule]
            near = max(1, said // 100_000)
            found = self.nearest([pair for check in checks for pair in check(said + near + 1).each()])
            self.equal(found, said, rule, near)

        least("smallest_gap", [lambda d, m=mask: m.width_check(d, False, projection) for mask in masks])
        least("smallest_line", [lambda d, m=mask: m.space_check(d, False, projection) for mask in masks])
        least("chamber_overlap", [lambda d, p=part: chamber.enclosing_check(p, d, False, projection) for part in parts])
        least("undercut", [lambda d: electrode.enclosing_check(base, d, False, projection)])

    def check_markers(self):
        """The marker browser's database has an item for each place that was told, in its cell and category."""
        with open(self.name + ".rules") as lines:
            told = re.findall(r"rule (\w+) is .* at \(([-.0-9]+), ([-.0-9]+)\) um of (\w+),", lines.read())
        markers = pya.ReportDatabase("markers")
        markers.load(self.name + ".lyrdb")
        self.expect(markers.top_cell_name == self.top.name, f"top cell {markers.top_cell_name} of markers")
        found = []
        for item in markers.each_item():
            boxes = [value.box() for value in item.each_value() if value.is_box()]
            texts = [value.string() for value in item.each_value() if value.is_string()]
            self.expect(len(boxes) == 1 and len(texts) == 1, "a marker without place or text")
            rule, cell = markers.category_by_id(item.category_id()).name(), markers.cell_by_id(item.cell_id()).name()
            self.expect(all(text.startswith(rule + " is ") for text in texts), f"marker text {texts}")
            found += [(rule, f"{box.center().x:.3f}", f"{box.center().y:.3f}", cell) for box in boxes]
        told = [(rule, f"{float(x):.3f}", f"{float(y):.3f}", cell) for rule, x, y, cell in told]
        self.expect(len(told) > 0 and sorted(found) == sorted(told), f"markers {found}, told {told}")

    @staticmethod
    def no_sliver(region, least):
        """Nothing narrower than half of what is drawn as narrowest: no accident of polygons that almost coincide."""
        limit = max(1, least // 2)
        projection = pya.Region.Projection
        return (region.width_check(limit, False, projection).is_empty()
                and region.space_check(limit, False, projection).is_empty())


try:
    ruled = 0
    names = sorted(path[:-4] for path in glob.glob("*.gds"))
    for one in names:
        drawing = Drawing(one)
        drawing.check_layers()
        drawing.check_masks()
        for device in sorted({row["cell"] for row in drawing.rows if row["cell"].startswith("DEVICE")}):
            drawing.check_device(device)
        if os.path.exists(one + ".rules"):
            drawing.check_rules()
            drawing.check_markers()
            ruled += 1
    if len(names) < 10 or ruled < 10:
        wrong.append(f"only {len(names)} drawings")
except Exception:
    wrong.append(traceback.format_exc())
for line in wrong:
    print(line, file=sys.stderr)
if not wrong:
    with open("klayout.json", "w") as result:
        json.dump(boxes, result)
    print(f"KLayout {pya.Application.instance().version() if hasattr(pya, 'Application') else ''}: {len(names)} drawings agree")
