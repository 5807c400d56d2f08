#include "program/command_line.hpp"

#include "graze/identify/fit.hpp"
#include "program/commands.hpp"

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

void declare_channels(CommandOptions& options, IdentifyArguments& identify) {
    options.in("Channels");
    options.add("--channel NAME", identify.request.channel, "Decrement, restitution: the velocity (v)");
    options.add("--displacement NAME", identify.request.displacement,
                "Coupling: the displacement (q). Restitution: the displacement, whose kinks give the times of impacts");
    options.add("--voltage NAME", identify.request.voltage, "Impedance: the voltage (V)");
    options.add("--current NAME", identify.request.current, "Coupling, impedance: the current (I)");
    declare_reading(options, identify.reading);
}

void declare_known(CommandOptions& options, IdentifyArguments& identify) {
    options.in("Each kind of estimate");
    options.add("--peaks N", identify.request.peaks,
                "Decrement: number of peaks that are used, the first of each record (10)", whole_number(2, 100'000));
    options.add("--window N", identify.request.impacts.window,
                "Restitution: samples on each side of an impact to which velocities are fitted (12)",
                whole_number(ImpactWindow::least_window, ImpactWindow::most_window));
    options.add("--transition N", identify.request.impacts.transition,
                "Restitution: samples on each side left out since the impact itself disturbs them (0)",
                whole_number(0, ImpactWindow::most_window));
    options.add("--least-jump VALUE", identify.request.impacts.least_jump,
                "Restitution: smallest jump of the velocity that is an impact, in its unit (0)", non_negative_number());
    options.add("--gap D", identify.request.gap, "Coupling, impedance: gap at rest, in the unit of the displacement",
                positive_number());
    options.add("--stiffness K", identify.request.stiffness,
                "Coupling: stiffness, the mass times the square of the natural frequency", positive_number());
    options.add("--gap-error D", identify.request.gap_error, "Coupling: standard error of the gap (0)",
                non_negative_number());
    options.add("--stiffness-error K", identify.request.stiffness_error,
                "Coupling: standard error of the stiffness (0)", non_negative_number());
    options
        .add("--noise Q,I", identify.noise,
             "Coupling: noise of displacement and current; only its ratio matters (that of their largest values)")
        ->delimiter(',')
        ->expected(2);
    options.add("--frequency F", identify.request.frequency,
                "Impedance: approximate frequency of the voltage (that of its largest spectral line)",
                positive_number());
    options.add("--beta1 VALUE[+-ERROR]", identify.beta1,
                "Impedance: with --beta2 and --gap gives the leakage inductance too, L - beta1/(beta2 + gap - q)");
    options.add("--beta2 VALUE[+-ERROR]", identify.beta2, "Impedance: see --beta1");
    options.add("--clamped Q", identify.request.clamped, "Impedance: displacement q at which the mass is clamped (0)",
                finite_number());
}

void declare_fit(CommandOptions& options, IdentifyArguments& identify) {
    options.in("Fit");
    options.add("--free NAME[=GUESS][:LEAST:GREATEST]", identify.free,
                "Parameters to be found, with guesses (the model's values) and bounds (none)");
    options.add("--set NAME=VALUE", identify.set, "Values of other parameters");
    options.add("--with FILE:NAME=VALUE", identify.own,
                "Values of parameters in one record only, if records were taken under different conditions");
    options.add("--start STATE=VALUE", identify.start,
                "Guesses of the states at the first time (from the readings, or the model)");
    options.add("--known STATE,...", identify.known,
                "States whose initial values are known, by --start or the model, and not fitted; `all`: every state");
    options.add("--mode MODE", identify.mode, "Mode at the first time (the model's initial mode)");
    options.add("--reading CHANNEL=EXPRESSION", identify.meanings,
                "Quantity that a channel measures (the state or quantity of its name; other channels are not used)");
    options.add("--gain CHANNEL[=GUESS]", identify.gains, "Channels whose gain is fitted too, with a guess (1)");
    options.add("--offset CHANNEL[=GUESS]", identify.offsets, "Channels whose offset is fitted too, with a guess (0)");
    options.add("--deviation CHANNEL=VALUE", identify.noises,
                "Standard deviation of a channel's noise (estimated from the residuals)");
    options.add("--loss LOSS", identify.loss, "Loss function: squares (default); huber or cauchy if there are outliers",
                one_of(names_of_losses()));
    options.add("--piece T", identify.piece,
                "Length in time of the pieces into which records are cut (about thirty readings); shorter ones help "
                "a fit with poor guesses");
    options.add("--time-limit S", identify.time_limit, "End after S seconds and report what does not match (no limit)",
                positive_number());
    options.progress(identify.progress);
    options.add("--table TABLE", identify.table, "numbers (default), outputs, correlations or readings",
                one_of(fit_table_names()));
    options.add("--save FILE", identify.save, "Write the fitted values to FILE, for --set @FILE and --from @FILE");
}

} // namespace

std::vector<std::string> fit_table_names() {
    return {"numbers", "outputs", "correlations", "readings"};
}

void declare_identify_command(CommandLine& line) {
    auto [options, identify] = line.command("identify", identify_text, identify_examples, identify_command);
    options.add("WHAT", identify.what, "decrement, restitution, coupling, impedance or fit; or a study, without FILE");
    options.add("[FILE]", identify.reading.files, "Records; for a fit the model comes first");
    declare_channels(options, identify);
    declare_known(options, identify);
    declare_fit(options, identify);
    options.table(identify.reading.output);
    options.picture(identify.reading.plot, identify.reading.data,
                    "Draw the fit and its residuals too, as svg, png or pdf");
}

} // namespace graze
