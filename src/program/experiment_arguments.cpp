#include "program/experiment_arguments.hpp"

#include "program/commands.hpp"
#include "program/declared_option.hpp"

#include <string>
#include <vector>

namespace graze {

namespace {

constexpr const char* bench_text = R"(Simulate an experiment: a function generator that drives a model.
Opens a serial line (a pseudo-terminal with the name of --port) that answers SCPI commands like an HP 33120A function
generator, and a TCP port on this machine that sends samples of the model's motion, as sensors and converters would show
it. The motion continues until Ctrl-C. `graze acquire` works with it as with hardware.)";

constexpr const char* bench_examples = R"(Examples:
  graze bench electromagnetic-testbed --port /tmp/generator --tcp 4711 --noise v=0.002 --range v=1
  graze bench electromagnetic-testbed --port /tmp/generator --on-demand --clip 6 --drop 0.001
  graze bench impact-oscillator --port /tmp/generator --amplitude amplitude --frequency omega=2*pi)";

constexpr const char* acquire_text = R"(Carry out an experiment: step a generator through levels, and record.
EXPERIMENT is a TOML file with the connections to the instruments, the limits, the levels, and what to record. Levels that
are recorded already are not recorded again: call the command again to continue. Whatever happens, the generator is brought
to its safe amplitude at the end.)";

constexpr const char* acquire_examples = R"(Examples:
  graze acquire sweep.toml --dry-run
  graze acquire sweep.toml --output records --live sections.svg --reference V --channel v
  graze acquire sweep.toml --port /tmp/generator --device tcp:127.0.0.1:4711)";

void declare_drive(CLI::App& command, BenchArguments& arguments) {
    const char* group = "Model and drive";
    declare_option(command, group, "--set", arguments.set, "NAME=VALUE", "Values of parameters (the model's)");
    declare_option(command, group, "--from", arguments.from, "NAME=VALUE", "Initial values of states (the model's)");
    declare_option(
        command, group, "--amplitude", arguments.amplitude, "NAME[=FACTOR]",
        "Parameter set to FACTOR (1), as of an amplifier, times half the generator's peak-to-peak voltage in V (V0)");
    declare_option(command, group, "--frequency", arguments.frequency, "NAME[=FACTOR]",
                   "Parameter set to FACTOR (1) times the generator's frequency in Hz (f)");
    declare_option(command, group, "--offset", arguments.offset, "NAME[=FACTOR]",
                   "Parameter set to FACTOR (1) times the generator's offset in V (none: it refuses offsets)");
    declare_option(command, group, "--time-unit", arguments.time_unit, "S", "The model's unit of time in seconds (1)")
        ->check(positive_number());
}

void declare_sensors(CLI::App& command, BenchArguments& arguments) {
    const char* group = "Sensors";
    declare_option(
        command, group, "--channel", arguments.channels, "NAME[=EXPR][:UNIT]",
        "Measured channels, such as x=q/beta2 or I:A (quantity `voltage` as V, and all states that are not cyclic)");
    declare_option(command, group, "--noise", arguments.noise, "NAME=VALUE",
                   "Standard deviation of a channel's noise, in its unit (0)");
    declare_option(command, group, "--bias", arguments.bias, "NAME=VALUE",
                   "Constant error of a channel, in its unit (0)");
    declare_option(command, group, "--drift", arguments.drift, "NAME=VALUE",
                   "Growth of a channel's error per second, in its unit (0)");
    declare_option(command, group, "--range", arguments.range, "NAME=VALUE",
                   "Range -VALUE to VALUE of a channel's converter, which clips and rounds (no converter)");
    declare_option(command, group, "--bits", arguments.bits, "N", "Resolution of the converters in bits (16)")
        ->check(whole_number(1, 32));
    declare_option(command, group, "--anti-alias", arguments.anti_alias, "HZ",
                   "Corner frequency of a fourth-order low-pass filter in each channel (no filter)")
        ->check(positive_number());
    declare_option(command, group, "--seed", arguments.seed, "N", "Seed of the noise and of lost characters (1)")
        ->check(whole_number(0, 1'000'000'000));
}

void declare_service(CLI::App& command, BenchArguments& arguments) {
    const char* group = "Connections and time";
    declare_option(command, group, "--port", arguments.port, "PATH", "Path of the serial line, which is created");
    declare_option(command, group, "--tcp", arguments.tcp, "PORT", "TCP port for samples, on 127.0.0.1 (a free one)")
        ->check(whole_number(0, 65535));
    declare_option(command, group, "--speed", arguments.speed, "FACTOR", "Simulated seconds per second (1)")
        ->check(positive_number());
    command
        .add_flag("--on-demand", arguments.on_demand,
                  "Advance time only as samples are read, as fast as possible: the same commands give the same samples")
        ->group(group);
    group = "Simulated faults";
    declare_option(command, group, "--clip", arguments.clip, "V",
                   "Limit the generator's amplitude to V without reporting an error (no limit)")
        ->check(positive_number());
    declare_option(
        command, group, "--left-as", arguments.left_as, "TEXT",
        "Commands of an earlier user that the generator has obeyed, such as \"VOLT:UNIT VRMS;:FUNC:SHAP SQU\"");
    declare_option(command, group, "--drop", arguments.drop, "P",
                   "Probability that a character on the serial line is lost (0)")
        ->check(number_between(0, 1));
    declare_option(command, group, "--delay", arguments.delay, "S",
                   "Delay of each answer of the generator in seconds (0)")
        ->check(non_negative_number());
    declare_option(command, group, "--break-after", arguments.break_after, "N",
                   "Interrupt the serial line after N lines (never)")
        ->check(whole_number(1, 1'000'000'000));
    declare_option(command, group, "--break-for", arguments.break_for, "S",
                   "Duration of that interruption in seconds (1)")
        ->check(non_negative_number());
    declare_option(command, group, "--break-samples", arguments.break_samples, "N",
                   "Close the connection for samples after every N rows (never)")
        ->check(whole_number(1, 1'000'000'000));
}

void declare_bench(CLI::App& app, BenchArguments& arguments) {
    CLI::App& command = *app.add_subcommand("bench", bench_text);
    command.footer(bench_examples);
    command.add_option("MODEL", arguments.model, "Name of a shipped model, or a file")->type_name("")->required();
    declare_drive(command, arguments);
    declare_sensors(command, arguments);
    declare_service(command, arguments);
}

void declare_acquire(CLI::App& app, AcquireArguments& arguments) {
    CLI::App& command = *app.add_subcommand("acquire", acquire_text);
    command.footer(acquire_examples);
    command.add_option("EXPERIMENT", arguments.experiment, "Experiment file")->type_name("")->required();
    const char* group = "Instruments";
    declare_option(command, group, "--port", arguments.port, "PATH", "Serial line of the generator (that of the file)");
    declare_option(command, group, "--device", arguments.device, "ADDRESS",
                   "Source of the samples, tcp:HOST:PORT or serial:PATH (that of the file)");
    group = "Output";
    declare_option(command, group, "--output", arguments.folder, "FOLDER",
                   "Folder of the records (the name of the experiment)");
    command.add_flag("--dry-run", arguments.dry_run, "Check the experiment and print its levels; send nothing")
        ->group(group);
    command.add_flag("--progress", arguments.progress, "Show progress even if standard error is no terminal")
        ->group(group);
    group = "Picture during the experiment";
    declare_option(command, group, "--live", arguments.live, "FILE",
                   "Draw stroboscopic sections of the records over the amplitude: svg, png or pdf");
    declare_option(command, group, "--reference", arguments.reference, "NAME",
                   "Channel that defines the periods (the first)");
    declare_option(command, group, "--phase", arguments.phase, "PART",
                   "Phase of the section, as a fraction of the period (0)")
        ->check(number_between(0, 1));
    declare_option(command, group, "--channel", arguments.channel, "NAME", "Channel that is drawn (the last)");
}

} // namespace

void declare_experiment_commands(CLI::App& app, Arguments& arguments) {
    declare_bench(app, arguments.bench);
    arguments.add_command("bench", bench_command, arguments.bench);
    declare_acquire(app, arguments.acquire);
    arguments.add_command("acquire", acquire_command, arguments.acquire);
}

} // namespace graze
