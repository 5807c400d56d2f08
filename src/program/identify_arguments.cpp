#include "program/identify_arguments.hpp"

#include "graze/identify/fit.hpp"
#include "program/commands.hpp"
#include "program/declared_option.hpp"
#include "program/record_arguments.hpp"

#include <string>
#include <vector>

namespace graze {

namespace {

constexpr const char* identify_text = R"(Find parameters from measured records, with their errors.
WHAT is one of
  decrement    natural frequency and damping ratio from free decaying oscillations, one in each record
  restitution  coefficient of restitution from impacts in a velocity, one record for each set of conditions
  coupling     constants of an electromagnet from equilibria, one in each row of the records
  impedance    resistance and inductance of a coil with its mass clamped, under a sinusoidal voltage
  fit          parameters and initial states of a model, named before the records, by least squares through impacts
or the name or file of a study: its runs of kind `identify` are computed if necessary, and their results shown.
Each value has its standard error and its 95 % confidence interval. The picture shows the measured and fitted values and
the residuals.)";

constexpr const char* identify_examples = R"(Examples:
  graze identify decrement release*.csv --channel v --plot decay.svg
  graze identify restitution run1.csv run2.csv --channel v --displacement q
  graze identify coupling static.csv --gap 4.79e-3 --stiffness 5948
  graze identify impedance clamped.csv --voltage V --current I --format json
  graze identify fit impact-oscillator run.csv --free zeta,e=0.7 --save found.toml
  graze simulate impact-oscillator --set @found.toml --from @found.toml --time 100
  graze identify testbed-experiment --format csv)";

void declare_channels(CLI::App& command, IdentifyArguments& arguments) {
    const char* group = "Channels";
    declare_option(command, group, "--channel", arguments.channel, "NAME", "Decrement, restitution: the velocity (v)");
    declare_option(
        command, group, "--displacement", arguments.displacement, "NAME",
        "Coupling: the displacement (q). Restitution: the displacement, whose kinks give the times of impacts");
    declare_option(command, group, "--voltage", arguments.voltage, "NAME", "Impedance: the voltage (V)");
    declare_option(command, group, "--current", arguments.current, "NAME", "Coupling, impedance: the current (I)");
    declare_reading(command, arguments.reading);
}

void declare_known(CLI::App& command, IdentifyArguments& arguments) {
    const char* group = "Each kind of estimate";
    declare_option(command, group, "--peaks", arguments.peaks, "N",
                   "Decrement: number of peaks that are used, the first of each record (10)")
        ->check(whole_number(2, 100'000));
    declare_option(command, group, "--window", arguments.impacts.window, "N",
                   "Restitution: samples on each side of an impact to which velocities are fitted (12)")
        ->check(whole_number(ImpactWindow::least_window, ImpactWindow::most_window));
    declare_option(command, group, "--transition", arguments.impacts.transition, "N",
                   "Restitution: samples on each side left out since the impact itself disturbs them (0)")
        ->check(whole_number(0, ImpactWindow::most_window));
    declare_option(command, group, "--least-jump", arguments.impacts.least_jump, "VALUE",
                   "Restitution: smallest jump of the velocity that is an impact, in its unit (0)")
        ->check(non_negative_number());
    declare_option(command, group, "--gap", arguments.gap, "D",
                   "Coupling, impedance: gap at rest, in the unit of the displacement")
        ->check(positive_number());
    declare_option(command, group, "--stiffness", arguments.stiffness, "K",
                   "Coupling: stiffness, the mass times the square of the natural frequency")
        ->check(positive_number());
    declare_option(command, group, "--gap-error", arguments.gap_error, "D", "Coupling: standard error of the gap (0)")
        ->check(non_negative_number());
    declare_option(command, group, "--stiffness-error", arguments.stiffness_error, "K",
                   "Coupling: standard error of the stiffness (0)")
        ->check(non_negative_number());
    declare_option(command, group, "--noise", arguments.noise, "Q,I",
                   "Coupling: noise of displacement and current; only its ratio matters (that of their largest values)")
        ->delimiter(',')
        ->expected(2);
    declare_option(command, group, "--frequency", arguments.frequency, "F",
                   "Impedance: approximate frequency of the voltage (that of its largest spectral line)")
        ->check(positive_number());
    declare_option(command, group, "--beta1", arguments.beta1, "VALUE[+-ERROR]",
                   "Impedance: with --beta2 and --gap gives the leakage inductance too, L - beta1/(beta2 + gap - q)");
    declare_option(command, group, "--beta2", arguments.beta2, "VALUE[+-ERROR]", "Impedance: see --beta1");
    declare_option(command, group, "--clamped", arguments.clamped, "Q",
                   "Impedance: displacement q at which the mass is clamped (0)");
}

void declare_fit(CLI::App& command, IdentifyArguments& arguments) {
    const char* group = "Fit";
    declare_option(command, group, "--free", arguments.free, "NAME[=GUESS][:LEAST:GREATEST]",
                   "Parameters to be found, with guesses (the model's values) and bounds (none)");
    declare_option(command, group, "--set", arguments.set, "NAME=VALUE", "Values of other parameters");
    declare_option(command, group, "--with", arguments.own, "FILE:NAME=VALUE",
                   "Values of parameters in one record only, if records were taken under different conditions");
    declare_option(command, group, "--start", arguments.start, "STATE=VALUE",
                   "Guesses of the states at the first time (from the readings, or the model)");
    declare_option(
        command, group, "--known", arguments.known, "STATE,...",
        "States whose initial values are known, by --start or the model, and not fitted; `all`: every state");
    declare_option(command, group, "--mode", arguments.mode, "MODE",
                   "Mode at the first time (the model's initial mode)");
    declare_option(command, group, "--reading", arguments.meanings, "CHANNEL=EXPRESSION",
                   "Quantity that a channel measures (the state or quantity of its name; other channels are not used)");
    declare_option(command, group, "--gain", arguments.gains, "CHANNEL[=GUESS]",
                   "Channels whose gain is fitted too, with a guess (1)");
    declare_option(command, group, "--offset", arguments.offsets, "CHANNEL[=GUESS]",
                   "Channels whose offset is fitted too, with a guess (0)");
    declare_option(command, group, "--deviation", arguments.noises, "CHANNEL=VALUE",
                   "Standard deviation of a channel's noise (estimated from the residuals)");
    declare_option(command, group, "--loss", arguments.loss, "LOSS",
                   "Loss function: squares (default); huber or cauchy if there are outliers")
        ->check(one_of(names_of_losses()));
    declare_option(command, group, "--piece", arguments.piece, "T",
                   "Length in time of the pieces into which records are cut (about thirty readings); shorter ones help "
                   "a fit with poor guesses");
    declare_option(command, group, "--time-limit", arguments.time_limit, "S",
                   "End after S seconds and report what does not match (no limit)")
        ->check(positive_number());
    command.add_flag("--progress", arguments.progress, "Show progress even if standard error is no terminal")
        ->group(group);
    declare_option(command, group, "--table", arguments.table, "TABLE",
                   "numbers (default), outputs, correlations or readings")
        ->check(one_of(fit_table_names()));
    declare_option(command, group, "--save", arguments.save, "FILE",
                   "Write the fitted values to FILE, for --set @FILE and --from @FILE");
}

} // namespace

std::vector<std::string> fit_table_names() {
    return {"numbers", "outputs", "correlations", "readings"};
}

void declare_identify_command(CLI::App& app, Arguments& all) {
    IdentifyArguments& arguments = all.identify;
    CLI::App& command = *app.add_subcommand("identify", identify_text);
    command.footer(identify_examples);
    all.add_command("identify", identify_command, all.identify);
    command
        .add_option("WHAT", arguments.what,
                    "decrement, restitution, coupling, impedance or fit; or a study, without FILE")
        ->type_name("")
        ->required();
    command.add_option("FILE", arguments.reading.files, "Records; for a fit the model comes first")->type_name("");
    declare_channels(command, arguments);
    declare_known(command, arguments);
    declare_fit(command, arguments);
    declare_table(command, arguments.reading.output);
    declare_option(command, "Picture", "--plot", arguments.reading.plot, "FILE",
                   "Draw the fit and its residuals too, as svg, png or pdf");
    declare_data(command, arguments.reading.data);
}

} // namespace graze
