#include "program/layout_arguments.hpp"

#include "program/commands.hpp"
#include "program/declared_option.hpp"

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

void declare_layout_command(CLI::App& app, Arguments& arguments) {
    LayoutArguments& layout = arguments.layout;
    CLI::App& command = *app.add_subcommand("layout", layout_text);
    command.footer(layout_examples);
    arguments.add_command("layout", layout_command, arguments.layout);
    command.add_option("DESIGN", layout.design, "Name of a shipped design, or a file")->type_name("")->required();
    declare_option(command, "What is drawn", "--set", layout.set, "NAME=VALUE",
                   "Replace a number of [device], in micrometres, or of [process], in its unit; repeat for several");
    command.add_flag("--wafer", layout.wafer, "Draw the wafer with all its devices, instead of one device")
        ->group("What is drawn");
    declare_option(command, "What is drawn", "--mask", layout.mask, "N", "Draw only mask 1 (mirrored) or 2 (both)")
        ->check(whole_number(1, 2));
    declare_option(
        command, "What is drawn", "--from-design", layout.from_design, "FOUND",
        "Draw the device found by 'graze design DESIGN --output FOUND', corrected for the etch; print its trip value");
    declare_option(command, "Where results go", "--output", layout.file, "FILE",
                   "Write the drawing as GDSII (.gds), or a picture as --picture does");
    declare_option(command, "Where results go", "--picture", layout.picture, "FILE",
                   "Draw a picture (.svg, .png or .pdf)");
    declare_option(command, "Where results go", "--parameters", layout.parameters, "FILE",
                   "Write mass, frequency, damping, area and gaps of the etched device, for --set @FILE");
    declare_option(command, "Where results go", "--verilog-a", layout.verilog, "FILE",
                   "Write the etched device as a module of Verilog-A for circuit simulators (.va)");
    declare_option(
        command, "Where results go", "--recipe", layout.recipe, "FILE",
        "Write the process recipe, step by step (.md), or draw cross-sections after each step (.svg, .png or .pdf)");
    declare_option(
        command, "Where results go", "--markers", layout.markers, "FILE",
        "Write the places that break a rule as markers of KLayout (.lyrdb), even if no other file is written");
    command.add_flag("--despite-rules", layout.despite_rules, "Write files although a rule of [rules] is broken")
        ->group("Where results go");
    const char* group = "Wafers of devices";
    declare_option(
        command, group, "--yield", layout.yield, "N",
        "Simulate N wafers with the variations of [spread]; tables and a map of the trip points go to a folder")
        ->check(whole_number(1, 100'000));
    declare_option(command, group, "--folder", layout.folder, "FOLDER",
                   "Folder of the wafers' tables, created if necessary (the design's name and -wafers)");
    declare_option(command, group, "--seed", layout.seed, "N", "Seed of the random numbers (1)")
        ->check(whole_number(0, 1'000'000'000));
    declare_option(command, group, "--jobs", layout.jobs, "N",
                   "Number of threads (one for each core); results do not depend on it")
        ->check(whole_number(1, 1024));
    declare_digits(command, layout.output);
}

} // namespace graze
