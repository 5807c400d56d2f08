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
  decrement    natural frequency and damping ratio from free oscillations that die out, a record each
  restitution  coefficient of restitution from impacts in a velocity, a record for each set of conditions
  coupling     constants of an electromagnet from equilibria: each row of the records is one
  impedance    resistance and inductance of a coil whose mass is clamped, under a sinusoidal voltage
  fit          any parameters and initial states of a model, named before the records: least squares through impacts
or the name or file of a study: what its runs of kind `identify` find is computed where that is not done, and shown.
Each value comes with its standard error and the interval that covers the truth with a probability of 95 %. The picture
shows what was measured, what was fitted, and what is left.)";

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
    declare_option(command, group, "--displacement", arguments.displacement, "NAME",
                   "Coupling: the displacement (q). Restitution: a channel whose corners tell the times of impacts");
    declare_option(command, group, "--voltage", arguments.voltage, "NAME", "Impedance: the voltage (V)");
    declare_option(command, group, "--current", arguments.current, "NAME", "Coupling, impedance: the current (I)");
    declare_reading(command, arguments.reading);
}

void declare_known(CLI::App& command, IdentifyArguments& arguments) {
    const char* group = "Of each kind";
    declare_option(command, group, "--peaks", arguments.peaks, "N", "Decrement: the first peaks of each release (10)")
        ->check(whole_number(2, 100'000));
    declare_option(command, group, "--window", arguments.impacts.window, "N",
                   "Restitution: samples on each side of an impact that tell velocities (12)")
        ->check(whole_number(ImpactWindow::least_window, ImpactWindow::most_window));
    declare_option(command, group, "--transition", arguments.impacts.transition, "N",
                   "Restitution: samples on each side that the impact itself disturbs (0)")
        ->check(whole_number(0, ImpactWindow::most_window));
    declare_option(command, group, "--least-jump", arguments.impacts.least_jump, "VALUE",
                   "Restitution: smaller jumps are no impacts (0)")
        ->check(non_negative_number());
    declare_option(command, group, "--gap", arguments.gap, "D", "Coupling, impedance: gap at rest")
        ->check(positive_number());
    declare_option(command, group, "--stiffness", arguments.stiffness, "K",
                   "Coupling: mass times square of natural frequency")
        ->check(positive_number());
    declare_option(command, group, "--gap-error", arguments.gap_error, "D", "Coupling: its standard error (0)")
        ->check(non_negative_number());
    declare_option(command, group, "--stiffness-error", arguments.stiffness_error, "K",
                   "Coupling: its standard error (0)")
        ->check(non_negative_number());
    declare_option(command, group, "--noise", arguments.noise, "Q,I",
                   "Coupling: noise of displacement and current, or their ratio (that of the largest ones)")
        ->delimiter(',')
        ->expected(2);
    declare_option(command, group, "--frequency", arguments.frequency, "F",
                   "Impedance: about the frequency of the voltage (that of its largest wave)")
        ->check(positive_number());
    declare_option(command, group, "--beta1", arguments.beta1, "VALUE[+-ERROR]",
                   "Impedance: with these the leakage inductance too, L - beta1/(beta2 + gap - q)");
    declare_option(command, group, "--beta2", arguments.beta2, "VALUE[+-ERROR]", "Impedance: likewise");
    declare_option(command, group, "--clamped", arguments.clamped, "Q",
                   "Impedance: displacement at which the mass is held (0)");
}

void declare_fit(CLI::App& command, IdentifyArguments& arguments) {
    const char* group = "Fit";
    declare_option(command, group, "--free", arguments.free, "NAME[=GUESS][:LEAST:GREATEST]",
                   "Parameters to be found, from these guesses (the model's values), within these bounds");
    declare_option(command, group, "--set", arguments.set, "NAME=VALUE", "Values of other parameters");
    declare_option(command, group, "--with", arguments.own, "FILE:NAME=VALUE",
                   "Parameters that one record has of its own");
    declare_option(command, group, "--start", arguments.start, "STATE=VALUE",
                   "Guesses of states at the first time (from readings, or the model)");
    declare_option(command, group, "--known", arguments.known, "STATE,...",
                   "States that begin as --start or the model says, and are not to be found; `all`: none are");
    declare_option(command, group, "--mode", arguments.mode, "MODE",
                   "Mode at the first time (the model's initial one)");
    declare_option(command, group, "--reading", arguments.meanings, "CHANNEL=EXPRESSION",
                   "What a channel measures (the state or quantity of its name; other channels are not used)");
    declare_option(command, group, "--gain", arguments.gains, "CHANNEL[=GUESS]",
                   "Channels whose gain is to be found, too (1)");
    declare_option(command, group, "--offset", arguments.offsets, "CHANNEL[=GUESS]",
                   "Channels whose offset is to be found, too (0)");
    declare_option(command, group, "--deviation", arguments.noises, "CHANNEL=VALUE",
                   "Standard deviation of a channel's noise (found from what is left)");
    declare_option(command, group, "--loss", arguments.loss, "LOSS",
                   "How far readings count: squares (default), huber, cauchy")
        ->check(one_of(names_of_losses()));
    declare_option(command, group, "--piece", arguments.piece, "T",
                   "Length of the pieces into which records are cut (some thirty readings)");
    declare_option(command, group, "--time-limit", arguments.time_limit, "S",
                   "End after so many seconds, and tell what does not match (none)")
        ->check(positive_number());
    command.add_flag("--progress", arguments.progress, "Show progress even if standard error is no terminal")
        ->group(group);
    declare_option(command, group, "--table", arguments.table, "TABLE",
                   "numbers (default), outputs, correlations or readings")
        ->check(one_of(fit_table_names()));
    declare_option(command, group, "--save", arguments.save, "FILE",
                   "Keep what was found, for --set @FILE and --from @FILE");
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
    command.add_option("WHAT", arguments.what, "decrement, restitution, coupling, impedance, fit; or a study, alone")
        ->type_name("")
        ->required();
    command.add_option("FILE", arguments.reading.files, "Records; of a fit, the model before them")->type_name("");
    declare_channels(command, arguments);
    declare_known(command, arguments);
    declare_fit(command, arguments);
    declare_table(command, arguments.reading.output);
    declare_option(command, "Picture", "--plot", arguments.reading.plot, "FILE",
                   "Draw what was fitted, too, as svg, png or pdf");
    declare_data(command, arguments.reading.data);
}

} // namespace graze
