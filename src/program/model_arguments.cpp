#include "program/command_line.hpp"
#include "program/commands.hpp"

namespace graze {

namespace {

constexpr const char* check_text = R"(Check a model and list its contents.
Warnings go to standard error. They name what is allowed but
probably a mistake, such as an event that no mode watches.)";

constexpr const char* check_examples = R"(Examples:
  graze check my-model.toml
  graze check impact-microactuator --graph modes.svg)";

constexpr const char* models_text = R"(List the shipped models, describe one, or write its file.
The microbeam is a family of models: --beam-modes
is the number of eigenmodes in which its motion is expanded.)";

constexpr const char* models_examples = R"(Examples:
  graze models
  graze models mems-switch
  graze models mems-switch --write my-switch.toml
  graze models microbeam --beam-modes 9 --write beam9.toml)";

constexpr const char* simulate_text = R"(Compute a trajectory.
Follows one trajectory from contact to contact without missing any, and prints a table: the states at equally spaced
times, unless --section, --contacts, --extrema, --minima or --derivatives asks for another table.
Values are numbers or expressions in the model's parameters, such as --time 2*pi/omega.)";

constexpr const char* simulate_examples = R"(Examples:
  graze simulate bouncing-ball --plot ball.svg
  graze simulate electromagnetic-testbed --set V0=4.833 --from I=0.1 --periods 20 --section phase0 --format csv
  graze simulate mems-switch --contacts --event stop --format csv
  graze simulate impact-oscillator --skip 100 --periods 5 --quantity energy --samples 1000 --output run.csv)";

void declare_check(CommandLine& line) {
    auto [options, check] = line.command("check", check_text, check_examples, check_command);
    options.add("MODEL", check.model, "Name of a shipped model, or a file");
    options.add(
        "--graph FILE", check.graph,
        "Draw the modes and the transitions between them (.svg, .png or .pdf by Graphviz; .dot needs no Graphviz)");
    options.output(check.output);
}

void declare_models(CommandLine& line) {
    auto [options, models] = line.command("models", models_text, models_examples, models_command);
    options.add("[NAME]", models.name, "The model to describe; without it all are listed");
    options.add("--show", models.show, "Print the model file");
    options.add("--write FILE", models.file, "Write the model file to FILE");
    options.in("Microbeam");
    options.add("--beam-modes N", models.beam_modes,
                "Number of eigenmodes of the microbeam (1); more are more accurate and slower");
    options.add("--quadrature RULE", models.quadrature,
                "Quadrature rule of the electrostatic force: simpson (default) or gauss");
    options.add("--points N", models.points, "Number of Simpson's intervals (even) or of Gauss's nodes (20)");
    options.digits(models.output);
}

void declare_length(CommandOptions& options, SimulateArguments& simulate) {
    options.in("How long (default: 20 periods)");
    options.add("--time T", simulate.time, "Simulate this time, in the model's unit");
    options.add("--periods N", simulate.length.periods, "Simulate N periods of the cyclic state");
    options.add("--contacts [N]", simulate.length.contacts,
                "With a number: simulate until N contacts; without: print the table of contacts");
    options.add("--phase STATE", simulate.length.phase,
                "Cyclic state whose periods are counted, if the model has several");
    options.add("--skip N", simulate.length.skip,
                "Simulate N periods before the output begins, as to skip a transient (0)");
    options.add("--after T", simulate.after, "Simulate this time before the output begins, as to skip a transient (0)");
}

void declare_tables(CommandOptions& options, SimulateArguments& simulate) {
    options.in("What to show");
    options.add("--section NAME", simulate.sections, "Print the states at each passage of these sections");
    options.add("--extrema EXPR", simulate.extrema, "Print the states at maxima and minima of these expressions");
    options.add("--event NAME", simulate.events, "Show and count only the contacts at these events (all)");
    options.add("--quantity EXPR", simulate.quantities,
                "More columns: quantities of the model, or any expressions in its names");
    options.add("--minima", simulate.minima,
                "Print the least value of each watched event function in each arc, with a guaranteed lower bound");
    options.add("--derivatives NAME", simulate.derivatives,
                "Print derivatives of the final state with respect to these initial states and parameters, or `all`");
    options.add("--samples N", simulate.samples, "Number of rows at equally spaced times (500)");
    options.add("--every DT", simulate.every, "Time between these rows, instead of their number");
    options.add("--table TABLE", simulate.table,
                "samples, contacts, sections, extrema, minima, derivatives or summary; needed only if the options "
                "above ask for several");
}

void declare_plot(CommandOptions& options, SimulateArguments& simulate) {
    options.in("Picture");
    options.add("--plot FILE", simulate.plot,
                "Draw time histories and phase portraits as svg, png, pdf or eps, by gnuplot; --quantity chooses "
                "the histories");
    options
        .add("--portrait X,Y", simulate.portraits,
             "Axes of phase portraits, a pair for each (a state and its velocity)")
        ->expected(1, -1);
    options.style(simulate.style);
    options.add("--data,--plot-data FILE", simulate.plot_data, kept_data_text);
}

void declare_method(CommandOptions& options, SimulateArguments& simulate) {
    options.in("Method");
    options.add("--tolerance TOL", simulate.method.tolerance, "Relative error of each step, 1e-16 to 1e-2 (1e-12)");
    options.add("--order N", simulate.method.order, "Order of the Taylor polynomials (chosen by the tolerance)");
    options.add("--largest-step T", simulate.largest_step,
                "Largest step in time (unbounded); contacts are found without it");
    options.add("--steps N", simulate.method.step_limit, "End after N steps (100 million)",
                whole_number(1, 1'000'000'000'000));
    options.progress(simulate.progress);
    options.add("--quiet", simulate.quiet, "Report how the trajectory ended only if it broke off");
}

void declare_simulate(CommandLine& line) {
    auto [options, simulate] = line.command("simulate", simulate_text, simulate_examples, simulate_command);
    options.add("MODEL", simulate.model, "Name of a shipped model, or a file");
    options.in("Parameters and initial state");
    options.add("--set NAME=VALUE", simulate.set, "Values of parameters (the model's)");
    options.add("--from NAME=VALUE", simulate.from, "Initial values of states (the model's)");
    options.add("--mode NAME", simulate.mode, "Initial mode (the model's)");
    declare_length(options, simulate);
    options.in("");
    options.add("--contact-table", simulate.contacts, ""); // see with_joined_words
    declare_tables(options, simulate);
    declare_plot(options, simulate);
    options.table(simulate.output);
    declare_method(options, simulate);
}

} // namespace

void declare_model_commands(CommandLine& line) {
    declare_check(line);
    declare_models(line);
    declare_simulate(line);
}

} // namespace graze
