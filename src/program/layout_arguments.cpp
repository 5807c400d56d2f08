#include "program/command_line.hpp"

#include "program/commands.hpp"

namespace graze {

namespace {

constexpr const char* layout_text = R"(Draw the masks of a switch.
DESIGN is the name of a shipped design, or a TOML file whose table [device] has the dimensions (docs/layout.md): an H-shaped
mass on folded flexures, a fixed electrode, and two stops with a channel for a laser beam, on two masks. Prints areas and
gaps, measured on the drawn polygons, and the parameters of the model of the etched device. No file is written if a rule of
[rules] is broken.)";

constexpr const char* layout_examples = R"(Examples:
  graze layout mems-switch-device --output device.gds --picture device.svg
  graze layout mems-switch-device --wafer --output wafer.gds --picture wafer.png
  graze layout mine.toml --set "stop_gap=7.5 um" --set folds=2
  graze layout mine.toml --wafer --mask 1 --output mask1.gds        one mask alone
  graze layout mine.toml --set bias=0.4 --parameters etched.toml
  graze simulate mems-switch-device --set @etched.toml --time 6     motion of the etched device
  graze layout mems-switch-device --yield 25 --folder wafers
  graze design mems-switch-device --output found
  graze layout mems-switch-device --from-design found --output found/device.gds)";

} // namespace

void declare_layout_command(CommandLine& line) {
    auto [options, layout] = line.command("layout", layout_text, layout_examples, layout_command);
    options.add("DESIGN", layout.design, "Name of a shipped design, or a file");
    options.in("What is drawn");
    options.add("--set NAME=VALUE", layout.set,
                "Replace a number of [device], in micrometres, or of [process], in its unit; repeat for several");
    options.add("--wafer", layout.wafer, "Draw the wafer with all its devices, instead of one device");
    options.add("--mask N", layout.mask, "Draw only mask 1 (mirrored) or 2 (both)", whole_number(1, 2));
    options.add(
        "--from-design FOUND", layout.from_design,
        "Draw the device found by 'graze design DESIGN --output FOUND', corrected for the etch; print its trip value");
    options.in("Where results go");
    options.add("--output FILE", layout.file, "Write the drawing as GDSII (.gds), or a picture as --picture does");
    options.add("--picture FILE", layout.picture, "Draw a picture (.svg, .png or .pdf)");
    options.add("--parameters FILE", layout.parameters,
                "Write mass, frequency, damping, area and gaps of the etched device, for --set @FILE");
    options.add("--verilog-a FILE", layout.verilog,
                "Write the etched device as a module of Verilog-A for circuit simulators (.va)");
    options.add(
        "--recipe FILE", layout.recipe,
        "Write the process recipe, step by step (.md), or draw cross-sections after each step (.svg, .png or .pdf)");
    options.add("--markers FILE", layout.markers,
                "Write the places that break a rule as markers of KLayout (.lyrdb), even if no other file is written");
    options.add("--despite-rules", layout.despite_rules, "Write files although a rule of [rules] is broken");
    options.in("Wafers of devices");
    options.add("--yield N", layout.yield,
                "Simulate N wafers with the variations of [spread]; tables and a map of the trip points go to a folder",
                whole_number(1, 100'000));
    options.add("--folder FOLDER", layout.folder,
                "Folder of the wafers' tables, created if necessary (the design's name and -wafers)");
    options.seed(layout.seed, "Seed of the random numbers (1)");
    options.jobs(layout.jobs);
    options.digits(layout.output);
}

} // namespace graze
