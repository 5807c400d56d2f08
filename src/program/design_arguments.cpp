#include "program/design_arguments.hpp"

#include "program/commands.hpp"
#include "program/declared_option.hpp"

namespace graze {

namespace {

constexpr const char* design_text = R"(Design a switch that trips where its motion touches, or turns.
DESIGN is the name of one that comes with graze, or a TOML file (docs/design.md): a model, the parameter that drives it, the
dimensions that may be chosen with their ranges and tolerances, and what is wanted. The folder gets tables of where it trips,
how fast, down to where it remains so and how far all that depends on each dimension; a page for a review (page.svg,
page.pdf); the results that other commands read; and the device as a model file.)";

constexpr const char* design_examples = R"(Examples:
  graze design mems-switch --output switch
  graze design mems-switch --show > mine.toml      to begin one's own
  graze design mine.toml --output mine
  graze design --list                              those that come with graze)";

} // namespace

void declare_design_command(CLI::App& app, Arguments& arguments) {
    DesignArguments& design = arguments.design;
    CLI::App& command = *app.add_subcommand("design", design_text);
    command.footer(design_examples);
    arguments.add_command("design", design_command, arguments.design);
    command.add_option("DESIGN", design.design, "Name of one that comes with graze, or a file")->type_name("");
    const auto flag = [&](const char* group, const char* name, bool& value, const char* text) {
        return command.add_flag(name, value, text)->group(group);
    };
    declare_option(command, "Where results go", "--output", design.folder, "FOLDER",
                   "Folder, made if need be (the design's name)");
    flag("Where results go", "--no-pictures", design.no_pictures, "Draw no page");
    flag("Instead of a design", "--list", design.list, "List the designs that come with graze");
    flag("Instead of a design", "--show", design.show, "Print the file of one, to begin one's own");
    declare_option(command, "How it is done", "--jobs", design.jobs, "N",
                   "Threads (one for each core); results do not depend on them")
        ->check(whole_number(1, 1024));
    flag("How it is done", "--quiet", design.quiet, "Print no table");
    declare_digits(command, design.output);
}

} // namespace graze
