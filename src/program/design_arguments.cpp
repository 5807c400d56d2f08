#include "program/design_arguments.hpp"

#include "program/commands.hpp"
#include "program/declared_option.hpp"

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

void declare_design_command(CLI::App& app, Arguments& arguments) {
    DesignArguments& design = arguments.design;
    CLI::App& command = *app.add_subcommand("design", design_text);
    command.footer(design_examples);
    arguments.add_command("design", design_command, arguments.design);
    command.add_option("DESIGN", design.design, "Name of a shipped design, or a file")->type_name("");
    const auto flag = [&](const char* group, const char* name, bool& value, const char* text) {
        return command.add_flag(name, value, text)->group(group);
    };
    declare_option(command, "Where results go", "--output", design.folder, "FOLDER",
                   "Folder of the results, created if necessary (the design's name)");
    flag("Where results go", "--no-pictures", design.no_pictures, "Do not draw the page");
    flag("Instead of a design", "--list", design.list, "List the shipped designs");
    flag("Instead of a design", "--show", design.show, "Print the file of a shipped design, as a copy to change");
    declare_option(command, "How it is done", "--jobs", design.jobs, "N",
                   "Number of threads (one for each core); results do not depend on it")
        ->check(whole_number(1, 1024));
    flag("How it is done", "--quiet", design.quiet, "Do not print the table");
    declare_digits(command, design.output);
}

} // namespace graze
