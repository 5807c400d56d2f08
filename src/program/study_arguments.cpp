#include "program/study_arguments.hpp"

#include "graze/study/study_keys.hpp"
#include "program/commands.hpp"
#include "program/declared_option.hpp"

#include <map>

namespace graze {

namespace {

constexpr const char* run_text = R"(Do what a study asks for, and keep the results.
A study is a text file of named runs (simulations, sweeps of parameters, basins of attraction, periodic orbits and
branches of them) and of the pictures to be made from them. Results go to FOLDER/results.sqlite as they come, pictures
beside it. Run again, it only does what is not there yet or has changed; so a run that was interrupted, even by a power
cut, goes on where it stopped. The results are enough for that: instead of the study, name their folder or file.)";

constexpr const char* run_examples = R"(Examples:
  graze run --list
  graze run electromagnetic-testbed --output testbed
  graze run my-study.toml --output results --jobs 8
  graze run my-study.toml --only chain --steps
  graze run my-study.toml --set k=50              for another value; into the folder my-study-k=50
  graze run results                               go on with what is in results/results.sqlite
  graze run results --output again                do all of it again, elsewhere
  graze run mems-switch --show > my-switch.toml
  graze run --keys sweep                          what can be said of a sweep
  graze run --schema > study.schema.json          for an editor that completes TOML)";

constexpr const char* info_text = R"(Tell what is in a file.
Of results: the study, its runs with their points, when they were made, how, and by which version of graze; of a model
or a study what it has. Shipped models and studies go by their names.)";

constexpr const char* info_examples = R"(Examples:
  graze info results                   runs, counts, sizes, times
  graze info results --all             and all their parameters and settings
  graze info my-model.toml
  graze info mems-switch --format json)";

constexpr const char* export_text = R"(Take results out of the file of a study.
What is shown: points (one row for each parameter value, with what the motion settles on, or for each orbit of a
branch), samples, segments of the orbits of branches, multipliers of periodic orbits, the list of runs, or whatever a
query in SQL asks for (docs/result-file.md).)";

constexpr const char* export_examples = R"(Examples:
  graze export testbed --what runs
  graze export testbed --run sweep_6_25Hz --format csv --output points.csv
  graze export testbed --run sweep_6_25Hz --what samples --direction up --format csv
  graze export results --run chain --what segments --format csv
  graze export testbed --format hdf5 --output testbed.h5
  graze export testbed --sql "SELECT * FROM label_changes")";

constexpr const char* plot_text = R"(Draw the results of a study.
Without options: a picture of every run, by its kind, in the present folder.)";

constexpr const char* plot_examples = R"(Examples:
  graze plot testbed
  graze plot testbed --run sweep_7Hz --y v --direction up --x-range 3.6:3.8 --output onset.svg
  graze plot testbed --run sweep_6_25Hz --kind portrait --x I --y v --at V0=4.833 --output orbit.png
  graze plot results --run chain,doubled --y period --output branches.pdf
  graze plot results --run chain --kind portrait --point GR1 --output grazing.png)";

template <class Value>
CLI::Option* add(CLI::App& command, const char* name, Value& value, const char* type, const char* text) {
    return declare_option(command, "Options", name, value, type, text);
}

void declare_run(CLI::App& app, RunArguments& arguments) {
    CLI::App& command = *app.add_subcommand("run", run_text);
    command.footer(run_examples);
    add(command, "STUDY", arguments.study, "", "Name of a shipped study, a file, or results to go on with");
    add(command, "--output", arguments.folder, "FOLDER", "Where results and pictures go (the study's name)");
    add(command, "--jobs", arguments.jobs, "N", "Threads (as many as there are cores); results do not depend on it")
        ->check(whole_number(1, 1024));
    add(command, "--set", arguments.set, "NAME=VALUE", "Values of parameters instead of those in the study");
    add(command, "--only", arguments.only, "RUN",
        "Only these runs, with those that they start from, and pictures of nothing else");
    command.add_flag("--list", arguments.list, "List the shipped studies");
    command.add_flag("--show", arguments.show, "Print the study instead of running it");
    std::vector<std::string> kinds = kinds_of_runs();
    kinds.emplace_back("all");
    add(command, "--keys", arguments.keys, "KIND_OF_RUN",
        "List the keys of runs of this kind, such as sweep, or of all")
        ->check(one_of(kinds));
    command.add_flag("--schema", arguments.schema, "Print what studies may consist of, for editors: a JSON Schema");
    command.add_flag("--steps", arguments.steps, "Print a line for each orbit of a branch as it is found");
    command.add_flag("--no-pictures", arguments.no_pictures, "Compute only");
    command.add_flag("--progress", arguments.progress, "Show progress even if standard error is no terminal");
    command.add_flag("--quiet", arguments.quiet, "Do not list what was done");
    declare_format(command, arguments.output)->group("Options");
}

void declare_info(CLI::App& app, InfoArguments& arguments) {
    CLI::App& command = *app.add_subcommand("info", info_text);
    command.footer(info_examples);
    add(command, "FILE", arguments.file, "", "Result file, folder of a study, model or study")->required();
    command.add_flag("--all", arguments.all, "Parameters and settings of runs too, as csv and json have them always");
    declare_format(command, arguments.output)->group("Options");
    add(command, "--output", arguments.output.file, "FILE", "Write there instead of to standard output");
}

void declare_export(CLI::App& app, ExportArguments& arguments) {
    CLI::App& command = *app.add_subcommand("export", export_text);
    command.footer(export_examples);
    add(command, "FILE", arguments.file, "", "Result file, or the folder of a study")->required();
    add(command, "--run", arguments.runs, "RUN", "Only these runs (all)");
    add(command, "--what", arguments.what, "TABLE",
        "points (default), samples, segments, multipliers, half_multipliers, minima, end_values, estimates, "
        "covariances or runs");
    add(command, "--label", arguments.label, "LABEL",
        "Only points with this label, such as periodic; of branches also a type, such as GR");
    add(command, "--direction", arguments.direction, "WAY", "Only points of sweeps or branches up or down");
    add(command, "--sql", arguments.sql, "QUERY", "The rows of a query instead");
    add(command, "--format", arguments.hdf5, "FORMAT", "table (default), csv, json or hdf5")
        ->check(one_of({"table", "csv", "json", "hdf5"}));
    add(command, "--output", arguments.output.file, "FILE", "Write there instead of to standard output");
    add(command, "--digits", arguments.output.digits, "N",
        "Significant digits of numbers (8; 17 of csv and json, which lose nothing)")
        ->check(whole_number(1, 17));
    command.add_flag("--all", arguments.output.all, "All columns of a table, also those that do not fit a terminal");
}

void declare_plot_results(CLI::App& app, PlotArguments& arguments) {
    CLI::App& command = *app.add_subcommand("plot", plot_text);
    command.footer(plot_examples);
    add(command, "FILE", arguments.file, "", "Result file, or the folder of a study")->required();
    add(command, "--run", arguments.runs, "RUN",
        "Runs to be drawn (all; each by itself, but branches with --output together)");
    add(command, "--kind", arguments.kind, "KIND",
        "bifurcation, branch, basin, map, spectrum, history, portrait, regression or scatter")
        ->check(one_of({"bifurcation", "branch", "basin", "map", "spectrum", "history", "portrait", "poincare",
                        "regression", "scatter", "residuals"}));
    add(command, "--x", arguments.x, "NAME", "Horizontal axis: what varies, or a value");
    add(command, "--y", arguments.y, "NAME", "Vertical axes, one panel each (all values)");
    add(command, "--sample", arguments.samples, "NAME", "Only these samplings");
    add(command, "--direction", arguments.directions, "WAY", "Only sweeps or branches up or down");
    add(command, "--at", arguments.at, "NAME=VALUE", "Nearest points, of portraits, histories and spectra");
    add(command, "--point", arguments.points, "POINT",
        "Orbits of a branch by label or number, of portraits and histories");
    add(command, "--x-range", arguments.x_range, "A:B", "Limits of the horizontal axis");
    add(command, "--y-range", arguments.y_range, "A:B", "Limits of the vertical axes");
    add(command, "--fit", arguments.fit, "A:B", "Range of x that a regression uses");
    add(command, "--group", arguments.group, "NAME", "What varies between the lines of a regression");
    command.add_flag("--successive", arguments.successive, "Regression: each value against the one before it");
    add(command, "--log", arguments.logarithmic, "AXIS", "Logarithmic axes: x, y or both")->check(one_of({"x", "y"}));
    add(command, "--title", arguments.title, "TEXT", "Title");
    add(command, "--name", arguments.names, "NAME=TEXT",
        "What legends, titles and axes show in the place of names of runs, values, samplings");
    add(command, "--x-label", arguments.x_label, "TEXT", "All that stands beside the horizontal axis, unit included");
    add(command, "--y-label", arguments.y_labels, "TEXT", "The same of the vertical axes");
    add(command, "--size", arguments.style.size, "W[xH]", "Width in mm, such as 85 or 170 (170), and height");
    add(command, "--font", arguments.style.font, "FONT", "Size of letters in points, or NAME or NAME,SIZE");
    command.add_flag("--grey", arguments.style.grey, "Without colours, for printers that have none");
    add(command, "--output", arguments.output, "FILE", "Picture: .png (default), .svg, .pdf, .eps or, for LaTeX, .tex");
    add(command, "--data", arguments.data, "FILE", "Keep data and commands, to be changed and drawn by `gnuplot FILE`");
}

} // namespace

void declare_study_commands(CLI::App& app, Arguments& arguments) {
    declare_run(app, arguments.run);
    arguments.add_command("run", run_command, arguments.run);
    declare_info(app, arguments.info);
    arguments.add_command("info", info_command, arguments.info);
    declare_export(app, arguments.exports);
    arguments.add_command("export", export_command, arguments.exports);
    declare_plot_results(app, arguments.plot);
    arguments.add_command("plot", plot_command, arguments.plot);
}

} // namespace graze
