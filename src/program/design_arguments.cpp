#include "program/command_line.hpp"

#include "program/commands.hpp"

namespace graze {

namespace {

constexpr const char* design_text = R"(Design a switch that trips at a grazing or a fold of its motion.
DESIGN is the name of a shipped design or a TOML file (docs/design.md). It has a model, the parameter that drives it, the
dimensions that may be chosen with their ranges and tolerances, and the wishes. The output folder gets tables of the trip
point, the trip times, the range in which the outcome holds, and the dependence of all these on each dimension; a page for
a review (page.svg, page.pdf); the results that other commands read; and the device as a model file.)";

constexpr const char* design_examples = R"(Examples:
  graze design mems-switch --output switch
  graze design mems-switch --show > mine.toml      a copy to change
  graze design mine.toml --output mine
  graze design --list                              the shipped designs)";

} // namespace

void declare_design_command(CommandLine& line) {
    auto [options, design] = line.command("design", design_text, design_examples, design_command);
    options.add("[DESIGN]", design.design, "Name of a shipped design, or a file");
    options.in("Where results go");
    options.add("--output FOLDER", design.folder, "Folder of the results, created if necessary (the design's name)");
    options.add("--no-pictures", design.no_pictures, "Do not draw the page");
    options.in("Instead of a design");
    options.add("--list", design.list, "List the shipped designs");
    options.add("--show", design.show, "Print the file of a shipped design, as a copy to change");
    options.in("How it is done");
    options.jobs(design.jobs);
    options.add("--quiet", design.quiet, "Do not print the table");
    options.digits(design.output);
}

} // namespace graze
