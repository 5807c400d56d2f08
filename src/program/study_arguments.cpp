#include "program/study_arguments.hpp"

#include "graze/study/study_keys.hpp"
#include "program/commands.hpp"
#include "program/declared_option.hpp"

#include <map>

namespace graze {

namespace {

constexpr const char* run_text = R"(Compute the runs of a study, and keep the results.
A study is a text file that describes named runs (simulations, sweeps of parameters, basins of attraction, periodic orbits
and branches of them) and pictures of their results. Results go to FOLDER/results.sqlite as they are computed, pictures
beside it. The same command again computes only what is missing or has changed: a run that was interrupted, even by a power
cut, continues where it stopped. The results contain the study: their folder or file may be named instead of it.)";

constexpr const char* run_examples = R"(Examples:
  graze run --list
  graze run electromagnetic-testbed --output testbed
  graze run my-study.toml --output results --jobs 8
  graze run my-study.toml --only chain --steps
  graze run my-study.toml --set k=50              another value; results go to the folder my-study-k=50
  graze run results                               continue the study in results/results.sqlite
  graze run results --output again                compute it again in another folder
  graze run mems-switch --show > my-switch.toml
  graze run --keys sweep                          the keys of a run of kind sweep
  graze run --schema > study.schema.json          for an editor that completes TOML)";

constexpr const char* info_text = R"(Describe the contents of a file.
For results: the study, its runs and their points, when they were computed, and by which version of graze. For a model or
a study: its parts. Shipped models and studies are given by their names.)";

constexpr const char* info_examples = R"(Examples:
  graze info results                   runs, counts, sizes, times
  graze info results --all             parameters and settings of the runs too
  graze info my-model.toml
  graze info mems-switch --format json)";

constexpr const char* export_text = R"(Print tables of a result file, or export it.
Tables are: points (one row for each parameter value, with the attractor that was found, or for each orbit of a branch),
samples, segments of the orbits of branches, multipliers of periodic orbits, the list of runs, or the rows of a query in
SQL (docs/result-file.md).)";

constexpr const char* export_examples = R"(Examples:
  graze export testbed --what runs
  graze export testbed --run sweep_6_25Hz --format csv --output points.csv
  graze export testbed --run sweep_6_25Hz --what samples --direction up --format csv
  graze export results --run chain --what segments --format csv
  graze export testbed --format hdf5 --output testbed.h5
  graze export testbed --sql "SELECT * FROM label_changes")";

constexpr const char* plot_text = R"(Draw the results of a study.
Without options: one picture of each run, of the usual kind for it, in the current folder.)";

constexpr const char* plot_examples = R"(Examples:
  graze plot testbed
  graze plot testbed --run sweep_7Hz --y v --direction up --x-range 3.6:3.8 --output onset.svg
  graze plot testbed --run sweep_6_25Hz --kind portrait --x I --y v --at V0=4.833 --output orbit.png
  graze plot results --run chain,doubled --y period --output branches.pdf
  graze plot results --run chain --kind portrait --point GR1 --output grazing.png)";

template <class Value>
CLI::Option* add_study_option(CLI::App& command, const char* name, Value& value, const char* type, const char* text) {
    return declare_option(command, "Options", name, value, type, text);
}

void declare_run(CLI::App& app, RunArguments& arguments) {
    CLI::App& command = *app.add_subcommand("run", run_text);
    command.footer(run_examples);
    add_study_option(command, "STUDY", arguments.study, "",
                     "Name of a shipped study, a study file, or results to continue");
    add_study_option(command, "--output", arguments.folder, "FOLDER",
                     "Folder of results and pictures (the study's name)");
    add_study_option(command, "--jobs", arguments.jobs, "N",
                     "Number of threads (one for each core); results do not depend on it")
        ->check(whole_number(1, 1024));
    add_study_option(command, "--set", arguments.set, "NAME=VALUE",
                     "Values of parameters instead of those in the study");
    add_study_option(command, "--only", arguments.only, "RUN",
                     "Compute only these runs and those that they start from, with their pictures (all)");
    command.add_flag("--list", arguments.list, "List the shipped studies");
    command.add_flag("--show", arguments.show, "Print the file of a shipped study instead of running it");
    std::vector<std::string> kinds = kinds_of_runs();
    kinds.emplace_back("all");
    add_study_option(
        command, "--keys", arguments.keys, "KIND_OF_RUN",
        "List the keys of runs of this kind, such as sweep, or of all kinds: their values, defaults and meaning")
        ->check(one_of(kinds));
    command.add_flag("--schema", arguments.schema,
                     "Print a JSON Schema of study files, with which editors complete and check them");
    command.add_flag("--steps", arguments.steps, "Print a line for each orbit of a branch as it is found");
    command.add_flag("--no-pictures", arguments.no_pictures, "Compute only; write no pictures and tables");
    command.add_flag("--progress", arguments.progress, "Show progress even if standard error is no terminal");
    command.add_flag("--quiet", arguments.quiet, "Do not list the runs at the end");
    declare_format(command, arguments.output)->group("Options");
}

void declare_info(CLI::App& app, InfoArguments& arguments) {
    CLI::App& command = *app.add_subcommand("info", info_text);
    command.footer(info_examples);
    add_study_option(command, "FILE", arguments.file, "", "Result file, folder of a study, model or study")->required();
    command.add_flag("--all", arguments.all, "Show parameters and settings of runs too; csv and json always have them");
    declare_format(command, arguments.output)->group("Options");
    add_study_option(command, "--output", arguments.output.file, "FILE", "Write to FILE instead of to standard output");
}

void declare_export(CLI::App& app, ExportArguments& arguments) {
    CLI::App& command = *app.add_subcommand("export", export_text);
    command.footer(export_examples);
    add_study_option(command, "FILE", arguments.file, "", "Result file, or the folder of a study")->required();
    add_study_option(command, "--run", arguments.runs, "RUN", "Export only these runs (all)");
    add_study_option(
        command, "--what", arguments.what, "TABLE",
        "points (default), samples, segments, multipliers, half_multipliers, minima, end_values, estimates, "
        "covariances or runs");
    add_study_option(
        command, "--label", arguments.label, "LABEL",
        "Export only points with this label, such as periodic; for branches also a type, such as GR (all)");
    add_study_option(command, "--direction", arguments.direction, "WAY",
                     "Export only sweeps or branches in this direction (both)");
    add_study_option(command, "--sql", arguments.sql, "QUERY", "Export the rows of this query in SQL instead");
    add_study_option(command, "--format", arguments.hdf5, "FORMAT", "table (default), csv, json or hdf5")
        ->check(one_of({"table", "csv", "json", "hdf5"}));
    add_study_option(command, "--output", arguments.output.file, "FILE",
                     "Write to FILE instead of to standard output; if it is a folder, each run to a file in it");
    add_study_option(command, "--digits", arguments.output.digits, "N",
                     "Significant digits of numbers (8 in tables; 17, which is exact, in csv and json)")
        ->check(whole_number(1, 17));
    command.add_flag("--all", arguments.output.all,
                     "Show all columns of a table, even if they do not fit the terminal");
}

void declare_plot_results(CLI::App& app, PlotArguments& arguments) {
    CLI::App& command = *app.add_subcommand("plot", plot_text);
    command.footer(plot_examples);
    add_study_option(command, "FILE", arguments.file, "", "Result file, or the folder of a study")->required();
    add_study_option(command, "--run", arguments.runs, "RUN",
                     "Runs to be drawn (all): one picture for each run, but one for all branches with --output");
    add_study_option(
        command, "--kind", arguments.kind, "KIND",
        "bifurcation, branch, basin, map, spectrum, history, portrait, poincare, regression, scatter or residuals "
        "(chosen by the run)")
        ->check(one_of({"bifurcation", "branch", "basin", "map", "spectrum", "history", "portrait", "poincare",
                        "regression", "scatter", "residuals"}));
    add_study_option(command, "--x", arguments.x, "NAME",
                     "Horizontal axis: a state or quantity (the parameter that varies)");
    add_study_option(command, "--y", arguments.y, "NAME",
                     "Vertical axes: states or quantities, one panel each (all values)");
    add_study_option(command, "--sample", arguments.samples, "NAME",
                     "Draw only these samplings, such as sections (all)");
    add_study_option(command, "--direction", arguments.directions, "WAY",
                     "Draw only sweeps or branches in this direction (both)");
    add_study_option(command, "--at", arguments.at, "NAME=VALUE",
                     "Portraits, histories, Poincare sections and spectra: draw the point nearest to this value");
    add_study_option(command, "--point", arguments.points, "POINT",
                     "Portraits and histories: draw these orbits of a branch, by label or number");
    add_study_option(command, "--x-range", arguments.x_range, "A:B",
                     "Limits of the horizontal axis (the range of the data)");
    add_study_option(command, "--y-range", arguments.y_range, "A:B",
                     "Limits of the vertical axes (the range of the data)");
    add_study_option(command, "--fit", arguments.fit, "A:B", "Regression: range of x that is used (all)");
    add_study_option(command, "--group", arguments.group, "NAME",
                     "Regression: variable with one line for each of its values");
    command.add_flag("--successive", arguments.successive, "Regression: draw each value over the preceding one");
    add_study_option(command, "--log", arguments.logarithmic, "AXIS", "Logarithmic axes: x, y or both")
        ->check(one_of({"x", "y"}));
    add_study_option(command, "--title", arguments.title, "TEXT", "Title of the picture (chosen by its contents)");
    add_study_option(command, "--name", arguments.names, "NAME=TEXT",
                     "Text shown instead of the name of a run, value or sampling in legends, titles and axes");
    add_study_option(command, "--x-label", arguments.x_label, "TEXT",
                     "Label of the horizontal axis with its unit (made by graze)");
    add_study_option(command, "--y-label", arguments.y_labels, "TEXT",
                     "Labels of the vertical axes with their units (made by graze)");
    add_study_option(
        command, "--size", arguments.style.size, "W[xH]",
        "Width in mm, such as 85 or 170 for the columns of a journal (170), and height (chosen by the contents)");
    add_study_option(command, "--font", arguments.style.font, "FONT",
                     "Font size in points, font name, or NAME,SIZE (9)");
    command.add_flag("--grey", arguments.style.grey, "Draw in grey, for print without colours");
    add_study_option(command, "--output", arguments.output, "FILE",
                     "Picture: .png (default), .svg, .pdf, .eps or, for LaTeX, .tex");
    add_study_option(command, "--data", arguments.data, "FILE",
                     "Keep the data and commands of the picture; `gnuplot FILE` draws it again after changes");
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
