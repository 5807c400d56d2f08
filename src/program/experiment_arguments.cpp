#include "program/experiment_arguments.hpp"

#include "program/commands.hpp"
#include "program/declared_option.hpp"

#include <string>
#include <vector>

namespace graze {

namespace {

constexpr const char* bench_text = R"(Be an experiment without hardware: a generator that drives a model.
Gives a serial line (a pseudo-terminal under the name of --port) that answers SCPI as an HP 33120A function generator
does, and a TCP port on this machine with samples of the model's motion, as sensors and converters show it. The motion
goes on until Ctrl-C. `graze acquire` runs against it as it does against hardware.)";

constexpr const char* bench_examples = R"(Examples:
  graze bench electromagnetic-testbed --port /tmp/generator --tcp 4711 --noise v=0.002 --range v=1
  graze bench electromagnetic-testbed --port /tmp/generator --on-demand --clip 6 --drop 0.001
  graze bench impact-oscillator --port /tmp/generator --amplitude amplitude --frequency omega=2*pi)";

constexpr const char* acquire_text = R"(Carry out an experiment: step a generator, wait, record, again and again.
EXPERIMENT is a TOML file with the lines to the instruments, the limits, the levels, and what to record. Each record
counts as soon as it is there, and what is there already is not recorded again: call it again to go on. Whatever
happens, the generator is brought to its safe amplitude.)";

constexpr const char* acquire_examples = R"(Examples:
  graze acquire sweep.toml --dry-run
  graze acquire sweep.toml --output records --live sections.svg --reference V --channel v
  graze acquire sweep.toml --port /tmp/generator --device tcp:127.0.0.1:4711)";

void declare_drive(CLI::App& command, BenchArguments& arguments) {
    const char* group = "Model and drive";
    declare_option(command, group, "--set", arguments.set, "NAME=VALUE", "Values of parameters");
    declare_option(command, group, "--from", arguments.from, "NAME=VALUE", "Initial values of states");
    declare_option(
        command, group, "--amplitude", arguments.amplitude, "NAME[=FACTOR]",
        "Parameter that is FACTOR (1), an amplifier's, times half of the amplitude from peak to peak in V (V0)");
    declare_option(command, group, "--frequency", arguments.frequency, "NAME[=FACTOR]",
                   "Parameter that is FACTOR (1) times the frequency in Hz (f)");
    declare_option(command, group, "--offset", arguments.offset, "NAME[=FACTOR]",
                   "Parameter that is FACTOR (1) times the offset in V (none: the generator gives no offset)");
    declare_option(command, group, "--time-unit", arguments.time_unit, "S",
                   "Seconds that a unit of the model's time lasts (1)")
        ->check(positive_number());
}

void declare_sensors(CLI::App& command, BenchArguments& arguments) {
    const char* group = "Sensors";
    declare_option(
        command, group, "--channel", arguments.channels, "NAME[=EXPR][:UNIT]",
        "What is measured, such as x=q/beta2 or I:A (quantity `voltage` as V, and all states that are not cyclic)");
    declare_option(command, group, "--noise", arguments.noise, "NAME=VALUE", "Standard deviation of its noise (0)");
    declare_option(command, group, "--bias", arguments.bias, "NAME=VALUE", "What is added to it (0)");
    declare_option(command, group, "--drift", arguments.drift, "NAME=VALUE", "What that gains in a second (0)");
    declare_option(command, group, "--range", arguments.range, "NAME=VALUE",
                   "Its converter goes from -VALUE to VALUE (without a converter)");
    declare_option(command, group, "--bits", arguments.bits, "N", "Of converters (16)")->check(whole_number(1, 32));
    declare_option(command, group, "--anti-alias", arguments.anti_alias, "HZ",
                   "Corner of a low-pass filter of fourth order in each channel (none)")
        ->check(positive_number());
    declare_option(command, group, "--seed", arguments.seed, "N", "Of noise and of what gets lost (1)")
        ->check(whole_number(0, 1'000'000'000));
}

void declare_service(CLI::App& command, BenchArguments& arguments) {
    const char* group = "Connections and time";
    declare_option(command, group, "--port", arguments.port, "PATH", "Name of the serial line");
    declare_option(command, group, "--tcp", arguments.tcp, "PORT", "For samples, on 127.0.0.1 (one that is free)")
        ->check(whole_number(0, 65535));
    declare_option(command, group, "--speed", arguments.speed, "FACTOR", "Seconds of the bench in a second (1)")
        ->check(positive_number());
    command
        .add_flag("--on-demand", arguments.on_demand,
                  "Time passes only as samples are read, as fast as can be: the same commands give the same samples")
        ->group(group);
    group = "What goes wrong";
    declare_option(command, group, "--clip", arguments.clip, "V",
                   "The generator gives no larger amplitude, and has no error")
        ->check(positive_number());
    declare_option(command, group, "--left-as", arguments.left_as, "TEXT",
                   "The generator stands as these commands have left it, such as \"VOLT:UNIT VRMS;:FUNC:SHAP SQU\"");
    declare_option(command, group, "--drop", arguments.drop, "P",
                   "Probability of a letter on the serial line to get lost (0)")
        ->check(number_between(0, 1));
    declare_option(command, group, "--delay", arguments.delay, "S", "Before each answer of the generator (0)")
        ->check(non_negative_number());
    declare_option(command, group, "--break-after", arguments.break_after, "N", "The serial line breaks after N lines")
        ->check(whole_number(1, 1'000'000'000));
    declare_option(command, group, "--break-for", arguments.break_for, "S", "For so long (1)")
        ->check(non_negative_number());
    declare_option(command, group, "--break-samples", arguments.break_samples, "N",
                   "The connection for samples breaks after N rows, each time")
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
    command.add_option("EXPERIMENT", arguments.experiment, "File of the experiment")->type_name("")->required();
    const char* group = "Instruments";
    declare_option(command, group, "--port", arguments.port, "PATH",
                   "Serial line of the generator, in the place of the file's");
    declare_option(command, group, "--device", arguments.device, "ADDRESS",
                   "Where samples come from, in the place of the file's: tcp:HOST:PORT or serial:PATH");
    group = "Output";
    declare_option(command, group, "--output", arguments.folder, "FOLDER",
                   "For the records (the name of the experiment)");
    command.add_flag("--dry-run", arguments.dry_run, "Check all, print the levels, and send nothing")->group(group);
    command.add_flag("--progress", arguments.progress, "Show progress even if standard error is no terminal")
        ->group(group);
    group = "Picture while it goes on";
    declare_option(command, group, "--live", arguments.live, "FILE",
                   "Sections of the records over the amplitude: svg, png or pdf");
    declare_option(command, group, "--reference", arguments.reference, "NAME",
                   "Channel whose periods count (the first)");
    declare_option(command, group, "--phase", arguments.phase, "PART", "Part of the period at which the section is (0)")
        ->check(number_between(0, 1));
    declare_option(command, group, "--channel", arguments.channel, "NAME", "What is drawn (the last)");
}

} // namespace

void declare_experiment_commands(CLI::App& app, Arguments& arguments) {
    declare_bench(app, arguments.bench);
    arguments.add_command("bench", bench_command, arguments.bench);
    declare_acquire(app, arguments.acquire);
    arguments.add_command("acquire", acquire_command, arguments.acquire);
}

} // namespace graze
