"""Areas by gdspy compared with those of graze, and boxes with those that KLayout has found (klayout.json)."""
import csv
import json
import sys

import gdspy

wrong = []
with open("klayout.json") as file:
    boxes = json.load(file)
for name, layers in boxes.items():
    library = gdspy.GdsLibrary(infile=name + ".gds")
    if abs(library.unit - 1e-6) > 1e-18 or abs(library.precision - 1e-9) > 1e-21:
        wrong.append(f"{name}: units {library.unit}, {library.precision}")
    with open(name + ".csv", newline="") as rows:
        said = {row["what"].split(":")[0][6:]: float(row["value"])
                for row in csv.DictReader(rows) if row["what"].startswith("layer ")}
    top = library.cell_dict["WAFER" if "WAFER" in library.cell_dict else "DEVICE"]
    areas = top.area(by_spec=True)
    polygons = top.get_polygons(by_spec=True)
    for layer, box in layers.items():
        key = tuple(map(int, layer.split("/")))
        if abs(areas[key] - said[layer]) > 1e-9 * said[layer]:
            wrong.append(f"{name} {layer}: area {areas[key]} by gdspy, {said[layer]} by graze")
        points = [point for polygon in polygons[key] for point in polygon]
        found = [min(x for x, _ in points), min(y for _, y in points), max(x for x, _ in points), max(y for _, y in points)]
        # KLayout has rounded the corners of what is turned.
        if any(abs(1000 * one - other) > 1.001 for one, other in zip(found, box)):
            wrong.append(f"{name} {layer}: box {found} by gdspy, {box} by KLayout")
for line in wrong:
    print(line, file=sys.stderr)
if wrong or not boxes:
    sys.exit(1)
print(f"gdspy {gdspy.__version__}: {len(boxes)} drawings agree")
