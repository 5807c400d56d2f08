#include "program/command_line.hpp"

#include "graze/atlas/atlas_tables.hpp"
#include "graze/study/study_keys.hpp"
#include "program/commands.hpp"

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
  graze run my-study.toml --part 3/64             a share of it, for example on one of 64 machines
  graze run my-study.toml --slurm 64 -- --time=2:00:00 --cpus-per-task=4
                                                  64 shares as jobs of SLURM
  graze run results                               continue the study in results/results.sqlite
  graze run results --output again                compute it again in another folder
  graze run mems-switch --show > my-switch.toml
  graze run --keys sweep                          the keys of a run of kind sweep
  graze run --schema > study.schema.json          for an editor that completes TOML)";

constexpr const char* atlas_text = R"(Explore what can happen in a box of one or two parameters.
Motions are simulated all over the box. From the attractors that they settle on, branches of periodic orbits are followed,
switched at their flips, branch points and grazings. In two parameters the curves of all these points are followed, and those
that begin where curves meet, until nothing new is found. The branches are compared with the motions. FOLDER gets the results,
one picture and one table; the same command goes on with an atlas that was interrupted. A run of kind "atlas" of a study does
the same. Without --along: show the atlas that is in results.)";

constexpr const char* atlas_examples = R"(Examples:
  graze atlas impact-oscillator --along omega=2.6:2.9
  graze atlas impact-microactuator --along V=0.01:1.1 --along omega=0.6:1.4:5 --contacts 4 --multiple 2
  graze atlas my-model.toml --along k=1:5:101 --along f=2:3:11 --minutes 10
  graze atlas my-model-atlas                       what it has found
  graze atlas my-model-atlas --what curves         every curve, and what lies on it
  graze atlas my-model-atlas --format csv          every curve and point, with all digits)";

constexpr const char* merge_text =
    R"(Put the parts of a study together, which several processes or machines have computed.
Each part is a file that graze run STUDY --part K/N has written. The results are those that one process would have made, to
the last bit, however many parts there are and however often they were interrupted or repeated. What is missing is said;
the parts that are there are kept, and graze run FOLDER computes the rest.)";

constexpr const char* merge_examples = R"(Examples:
  graze run my-study.toml --output results --part 1/2     on one machine
  graze run my-study.toml --output results --part 2/2     on another, which writes to the same folder or to its own
  graze merge results
  graze merge results/parts/*.sqlite --output together)";

constexpr const char* view_text = R"(Look at results in a browser, and go on from there.
Prints the address of a page that only this machine can open, and serves it until Ctrl-C. It shows diagrams, the orbit of a
point that is clicked, and its motion; of results that another graze is still computing too. From a point, further runs are
begun by buttons: find its orbit, follow it, switch branches. They are added to the text of a study, which can be edited and
saved, and are computed in the background. Nothing is written but the results, while they are computed, and the study where
it is saved. The address contains a token, without which the page shows no data: do not pass it on.)";

constexpr const char* view_examples = R"(Examples:
  graze view results                   results, also while they are computed
  graze view my-study.toml             compute its runs, change it, and look at both
  graze view my-model.toml             begin with a model alone
  graze view microbeam --model         the shipped model, not the study of the same name
  graze view results --port 8080 --open)";

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
  graze plot results --run chain --kind portrait --point GR1 --output grazing.png
  graze plot results --output results.html)";

/// What is told of the runs.
void declare_reports(CommandOptions& options, StudyArguments& study) {
    options.add("--no-pictures", study.no_pictures, "Compute only; write no pictures and tables");
    options.progress(study.progress);
    options.add("--quiet", study.quiet, "Do not list the runs at the end");
    options.format(study.output);
}

void declare_run(CommandLine& line) {
    auto [options, run] = line.command("run", run_text, run_examples, run_command);
    options.add("[STUDY]", run.study, "Name of a shipped study, a study file, or results to continue");
    options.add("--output FOLDER", run.folder, "Folder of results and pictures (the study's name)");
    options.jobs(run.jobs);
    options.add("--set NAME=VALUE", run.set, "Values of parameters instead of those in the study");
    options.add("--only RUN", run.only,
                "Compute only these runs and those that they start from, with their pictures (all)");
    options.add("--list", run.list, "List the shipped studies");
    options.add("--show", run.show, "Print the file of a shipped study instead of running it");
    std::vector<std::string> kinds = kinds_of_runs();
    kinds.emplace_back("all");
    options.add(
        "--keys KIND_OF_RUN", run.keys,
        "List the keys of runs of this kind, such as sweep, or of all kinds: their values, defaults and meaning",
        one_of(kinds));
    options.add("--schema", run.schema,
                "Print a JSON Schema of study files, with which editors complete and check them");
    options.add(
        "--part K/N", run.part,
        "Compute only this part of the study, of N, into a file of its own in FOLDER/parts; graze merge puts the "
        "parts together");
    options.add("--slurm N", run.slurm,
                "Let SLURM compute the study in N parts, wait, and put them together; what follows -- is for sbatch",
                whole_number(1, 100'000));
    options.add("--no-wait", run.no_wait, "With --slurm: return as soon as the jobs are submitted");
    options.add("--steps", run.steps, "Print a line for each orbit of a branch as it is found");
    declare_reports(options, run);
    options.add("--sbatch TEXT", run.sbatch, "")->group(""); // what follows --: see with_joined_words
}

void declare_atlas(CommandLine& line) {
    auto [options, atlas] = line.command("atlas", atlas_text, atlas_examples, atlas_command);
    constexpr std::size_t many = 1'000'000;
    options.add("SUBJECT", atlas.subject, "A model, shipped or in a file; without --along results, or their folder");
    options.in("What is explored");
    options.add("--along NAME=FROM:TO", atlas.along,
                "A parameter, and the range in which motions begin; twice for two parameters. FROM:TO:POINTS gives the "
                "number of values, too (61 of the first, 9 of the second)");
    options.add("--set NAME=VALUE", atlas.set, "Values of other parameters");
    options.add("--from STATE=VALUE", atlas.from, "Initial state of the first motion (the model's)");
    options.add("--section NAME", atlas.section,
                "Section whose passages are counted as returns (the first section of a phase, or the first of all)");
    options.add(
        "--starts STATE=LOW:HIGH", atlas.starts,
        "Ranges of initial states from which motions begin at random (chosen by the extents of the other motions)");
    options.add("--draws N", atlas.draws, "Random initial states at every fourth value (2)", whole_number(0, many));
    options.add("--seed N", atlas.seed, "Seed of the random initial states (1)", whole_number(0, 1L << 53));
    options.in("How far");
    options.add("--contacts N", atlas.contacts,
                "Most contacts with barriers in a return of orbits that are followed (8)", whole_number(0, many));
    options.add("--multiple N", atlas.multiple, "Longest period, in returns, of orbits that are followed (4)",
                whole_number(1, many));
    options.add("--branches N", atlas.branches, "Most branches (300)", whole_number(1, many));
    options.add("--curves N", atlas.curves, "Most curves (100)", whole_number(0, many));
    options.add("--minutes T", atlas.minutes, "Time after which nothing further is begun (no limit)",
                non_negative_number());
    options.in("Results");
    options.add("--output FOLDER", atlas.folder, "Folder of results and picture (the model's name and -atlas)");
    options.jobs(atlas.jobs);
    options.add("--no-pictures", atlas.no_pictures, "Compute only; write no picture and table");
    options.progress(atlas.progress);
    options.add("--quiet", atlas.quiet, "Print no summary and no tables");
    std::vector<std::string> tables = atlas_table_names();
    options.add("--what TABLE", atlas.what, "Show only this table: curves, points, branches, motions, or left",
                one_of(tables));
    options.add("--run RUN", atlas.run, "Of several atlases in the results, this one");
    options.digits(atlas.output);
    options.add("--all", atlas.output.all, "Show all columns of a table, even if they do not fit the terminal");
}

void declare_merge(CommandLine& line) {
    auto [options, merge] = line.command("merge", merge_text, merge_examples, merge_command);
    options.add("PARTS", merge.parts, "Folder of a study whose parts have been computed, or files of parts");
    options.add("--output FOLDER", merge.folder, "Folder of results and pictures (the one that is named)");
    declare_reports(options, merge);
}

void declare_view(CommandLine& line) {
    auto [options, view] = line.command("view", view_text, view_examples, view_command);
    options.add("[OPENED]", view.opened,
                "Results or their folder, a study, or a model: a file, or what comes with graze (the current folder)");
    options.add("--port N", view.port, "Port of the address (a free one)", whole_number(1, 65535));
    options.add("--output FOLDER", view.folder,
                "Folder of the results of a study or model, and of a study that is new (results: the study's name)");
    options.add("--model", view.model, "Of a name that a study and a model bear, the model is meant");
    options.add("--open", view.open, "Open the page in the browser that the desktop prefers");
    options.jobs(view.jobs);
}

void declare_info(CommandLine& line) {
    auto [options, info] = line.command("info", info_text, info_examples, info_command);
    options.add("FILE", info.file, "Result file, folder of a study, model or study");
    options.add("--all", info.all, "Show parameters and settings of runs too; csv and json always have them");
    options.format(info.output);
    options.add("--output FILE", info.output.file, "Write to FILE instead of to standard output");
}

void declare_export(CommandLine& line) {
    auto [options, exported] = line.command("export", export_text, export_examples, export_command);
    options.add("FILE", exported.file, "Result file, or the folder of a study");
    options.add("--run RUN", exported.runs, "Export only these runs (all)");
    options.add("--what TABLE", exported.what,
                "samples, segments, multipliers, half_multipliers, eigenvalues, minima, end_values, estimates, "
                "covariances or runs (points)");
    options.add("--label LABEL", exported.label,
                "Export only points with this label, such as periodic; for branches also a type, such as GR (all)");
    options.add("--direction WAY", exported.direction, "Export only sweeps or branches in this direction (both)");
    options.add("--sql QUERY", exported.sql, "Export the rows of this query in SQL instead");
    options.add("--format FORMAT", exported.hdf5, "table (default), csv, json or hdf5",
                one_of({"table", "csv", "json", "hdf5"}));
    options.add("--output FILE", exported.output.file,
                "Write to FILE instead of to standard output; if it is a folder, each run to a file in it");
    options.add("--digits N", exported.output.digits,
                "Significant digits of numbers (8 in tables; 17, which is exact, in csv and json)",
                whole_number(1, 17));
    options.add("--all", exported.output.all, "Show all columns of a table, even if they do not fit the terminal");
}

void declare_plot_results(CommandLine& line) {
    auto [options, plot] = line.command("plot", plot_text, plot_examples, plot_command);
    options.add("FILE", plot.file, "Result file, or the folder of a study");
    options.add("--run RUN", plot.picture.runs,
                "Runs to be drawn (all): one picture for each run, but one for all branches with --output");
    options.add(
        "--kind KIND", plot.picture.kind,
        "bifurcation, branch, atlas, basin, map, spectrum, history, portrait, poincare, regression, scatter, residuals "
        "(by the run)",
        one_of({"bifurcation", "branch", "atlas", "basin", "map", "spectrum", "history", "portrait", "poincare",
                "regression", "scatter", "residuals"}));
    options.add("--x NAME", plot.picture.x, "Horizontal axis: a state or quantity (the parameter that varies)");
    options.add("--y NAME", plot.picture.y, "Vertical axes: states or quantities, one panel each (all values)");
    options.add("--sample NAME", plot.picture.samplings, "Draw only these samplings, such as sections (all)");
    options.add("--direction WAY", plot.picture.directions, "Draw only sweeps or branches in this direction (both)");
    options.add("--at NAME=VALUE", plot.at,
                "Portraits, histories, Poincare sections and spectra: draw the point nearest to this value");
    options.add("--point POINT", plot.picture.points,
                "Portraits and histories: draw these orbits of a branch, by label or number");
    options.add("--x-range A:B", plot.x_range, "Limits of the horizontal axis (the range of the data)");
    options.add("--y-range A:B", plot.y_range, "Limits of the vertical axes (the range of the data)");
    options.add("--fit A:B", plot.fit, "Regression: range of x that is used (all)");
    options.add("--group NAME", plot.picture.group, "Regression: variable with one line for each of its values");
    options.add("--successive", plot.picture.successive, "Regression: draw each value over the preceding one");
    options.add("--log AXIS", plot.logarithmic, "Logarithmic axes: x, y or both", one_of({"x", "y"}));
    options.add("--title TEXT", plot.picture.title, "Title of the picture (chosen by its contents)");
    options.add("--name NAME=TEXT", plot.names,
                "Text shown instead of the name of a run, value or sampling in legends, titles and axes");
    options.add("--x-label TEXT", plot.picture.x_label, "Label of the horizontal axis with its unit (made by graze)");
    options.add("--y-label TEXT", plot.picture.y_labels,
                "Labels of the vertical axes with their units (made by graze)");
    options.style(plot.style);
    options.add("--output FILE", plot.output,
                "Picture: .png (default), .svg, .pdf, .eps, .tex for LaTeX, or .html: all runs and their orbits, for a "
                "browser");
    options.add("--data FILE", plot.data, kept_data_text);
}

} // namespace

void declare_study_commands(CommandLine& line) {
    declare_run(line);
    declare_atlas(line);
    declare_merge(line);
    declare_view(line);
    declare_info(line);
    declare_export(line);
    declare_plot_results(line);
}

} // namespace graze
