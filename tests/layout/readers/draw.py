"""Draws the shipped device, its wafer, a wafer of variants, and devices of random dimensions, each with its table (CSV).

usage: draw.py GRAZE, in the folder where they are to be
"""
import random
import subprocess
import sys

GRAZE = sys.argv[1]
WANTED, MOST = 25, 400
LARGEST = 100_000  # micrometres, more than all distances

# About these the random ones are.
USUAL = {
    "electrode_length": 2000, "electrode_width": 300, "gap": 15, "pad_length": 1000, "pad_width": 1000, "moat": 60,
    "base_inset": 40, "bar_width": 100, "bridge_width": 200, "clearance": 40, "flexure_width": 6,
    "flexure_length": 1150, "flexure_spacing": 30, "flexure_middle": 60, "truss_width": 40, "stop_gap": 9,
    "stop_width": 150, "channel_width": 200, "chamber_margin": 50, "mark_size": 300, "label_height": 140,
}


def draw(name, arguments, strict=False):
    """Returns whether it was drawn; a refusal must be one message.

    What is strict breaks all rules that compare distances, and tells the worst of each, which is kept beside the table
    together with their markers.
    """
    markers = ["--markers", f"{name}.lyrdb"] if strict else []
    done = subprocess.run([GRAZE, "layout", *arguments, *markers, "--output", f"{name}.gds", "--format", "csv"],
                          capture_output=True, text=True)
    if done.returncode == 2 and done.stderr.count("\n") == 1 and not done.stdout:
        return False
    if strict and done.returncode == 3:
        with open(f"{name}.rules", "w") as rules:
            rules.write(done.stderr)
    elif done.returncode != 0:
        sys.exit(f"{arguments}: exit {done.returncode}: {done.stderr}")
    with open(f"{name}.csv", "w") as table:
        table.write(done.stdout)
    return True


def must(name, arguments):
    if not draw(name, arguments):
        sys.exit(f"{arguments} was refused")


must("device", ["mems-switch-device"])
must("wafer", ["mems-switch-device", "--wafer"])
with open("variants.toml", "w") as design:
    design.write('name = "variants"\n[device]\n[wafer]\ndevices = 5\nvary = { stop_gap = [7, 8.5, 9.001], gap = [15, 14] }\n')
must("variants", ["variants.toml", "--wafer"])

with open("folded.toml", "w") as design:
    design.write('name = "folded"\n[device]\nfolds = 3\nelectrode_length = 1999.999\nchannel_width = 200.001\n'
                 'bar_width = 99.997\n[wafer]\ndevices = 7\n')
must("folded", ["folded.toml", "--wafer"])

generator = random.Random(16)
drawn = 0
for attempt in range(MOST):
    lengths = dict(USUAL, die_length=8000, die_width=8000, frame_width=300)
    for key in generator.sample(sorted(USUAL), 8):
        lengths[key] = round(USUAL[key] * 2.0 ** generator.uniform(-1.2, 1.2), 3)
    lengths["folds"] = generator.randint(1, 4)
    scale = 10.0 ** generator.uniform(-1, 1)
    with open("random.toml", "w") as design:
        design.write('name = "random"\n[device]\n')
        for key, value in lengths.items():
            design.write(f"{key} = {value if key == 'folds' else round(value * scale, 3)}\n")
        design.write("[rules]\n")
        for rule in ("smallest_line", "smallest_gap", "chamber_overlap", "undercut"):
            design.write(f"{rule} = {LARGEST}\n")
    if draw(f"random_{drawn}", ["random.toml", "--despite-rules"], strict=True):
        drawn += 1
    if drawn == WANTED:
        break
if drawn < WANTED:
    sys.exit(f"only {drawn} random devices could be drawn")
