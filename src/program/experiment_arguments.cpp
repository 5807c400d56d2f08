#include "program/command_line.hpp"

#include "program/commands.hpp"

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

void declare_drive(CommandOptions& options, BenchArguments& bench) {
    options.in("Model and drive");
    options.add("--set NAME=VALUE", bench.set, "Values of parameters (the model's)");
    options.add("--from NAME=VALUE", bench.from, "Initial values of states (the model's)");
    options.add(
        "--amplitude NAME[=FACTOR]", bench.amplitude,
        "Parameter set to FACTOR (1), as of an amplifier, times half the generator's peak-to-peak voltage in V (V0)");
    options.add("--frequency NAME[=FACTOR]", bench.frequency,
                "Parameter set to FACTOR (1) times the generator's frequency in Hz (f)");
    options.add("--offset NAME[=FACTOR]", bench.offset,
                "Parameter set to FACTOR (1) times the generator's offset in V (none: it refuses offsets)");
    options.add("--time-unit S", bench.time_unit, "The model's unit of time in seconds (1)", positive_number());
}

void declare_sensors(CommandOptions& options, BenchArguments& bench) {
    options.in("Sensors");
    options.add(
        "--channel NAME[=EXPR][:UNIT]", bench.channels,
        "Measured channels, such as x=q/beta2 or I:A (quantity `voltage` as V, and all states that are not cyclic)");
    options.add("--noise NAME=VALUE", bench.noise, "Standard deviation of a channel's noise, in its unit (0)");
    options.add("--bias NAME=VALUE", bench.bias, "Constant error of a channel, in its unit (0)");
    options.add("--drift NAME=VALUE", bench.drift, "Growth of a channel's error per second, in its unit (0)");
    options.add("--range NAME=VALUE", bench.range,
                "Range -VALUE to VALUE of a channel's converter, which clips and rounds (no converter)");
    options.add("--bits N", bench.bits, "Resolution of the converters in bits (16)", whole_number(1, 32));
    options.add("--anti-alias HZ", bench.anti_alias,
                "Corner frequency of a fourth-order low-pass filter in each channel (no filter)", positive_number());
    options.seed(bench.seed, "Seed of the noise and of lost characters (1)");
}

void declare_service(CommandOptions& options, BenchArguments& bench) {
    options.in("Connections and time");
    options.add("--port PATH", bench.port, "Path of the serial line, which is created");
    options.add("--tcp PORT", bench.tcp, "TCP port for samples, on 127.0.0.1 (a free one)", whole_number(0, 65535));
    options.add("--speed FACTOR", bench.speed, "Simulated seconds per second (1)", positive_number());
    options.add("--on-demand", bench.on_demand,
                "Advance time only as samples are read, as fast as possible: the same commands give the same samples");
    options.in("Simulated faults");
    options.add("--clip V", bench.clip, "Limit the generator's amplitude to V without reporting an error (no limit)",
                positive_number());
    options.add("--left-as TEXT", bench.left_as,
                "Commands of an earlier user that the generator has obeyed, such as \"VOLT:UNIT VRMS;:FUNC:SHAP SQU\"");
    options.add("--drop P", bench.drop, "Probability that a character on the serial line is lost (0)",
                number_between(0, 1));
    options.add("--delay S", bench.delay, "Delay of each answer of the generator in seconds (0)",
                non_negative_number());
    options.add("--break-after N", bench.break_after, "Interrupt the serial line after N lines (never)",
                whole_number(1, 1'000'000'000));
    options.add("--break-for S", bench.break_for, "Duration of that interruption in seconds (1)",
                non_negative_number());
    options.add("--break-samples N", bench.break_samples, "Close the connection for samples after every N rows (never)",
                whole_number(1, 1'000'000'000));
}

void declare_bench(CommandLine& line) {
    auto [options, bench] = line.command("bench", bench_text, bench_examples, bench_command);
    options.add("MODEL", bench.model, "Name of a shipped model, or a file");
    declare_drive(options, bench);
    declare_sensors(options, bench);
    declare_service(options, bench);
}

void declare_acquire(CommandLine& line) {
    auto [options, acquire] = line.command("acquire", acquire_text, acquire_examples, acquire_command);
    options.add("EXPERIMENT", acquire.experiment, "Experiment file");
    options.in("Instruments");
    options.add("--port PATH", acquire.port, "Serial line of the generator (that of the file)");
    options.add("--device ADDRESS", acquire.device,
                "Source of the samples, tcp:HOST:PORT or serial:PATH (that of the file)");
    options.in("Output");
    options.add("--output FOLDER", acquire.folder, "Folder of the records (the name of the experiment)");
    options.add("--dry-run", acquire.dry_run, "Check the experiment and print its levels; send nothing");
    options.progress(acquire.progress);
    options.in("Picture during the experiment");
    options.add("--live FILE", acquire.live,
                "Draw stroboscopic sections of the records over the amplitude: svg, png or pdf");
    options.add("--reference NAME", acquire.reference, "Channel that defines the periods (the first)");
    options.add("--phase PART", acquire.phase, "Phase of the section, as a fraction of the period (0)",
                number_between(0, 1));
    options.add("--channel NAME", acquire.channel, "Channel that is drawn (the last)");
}

} // namespace

void declare_experiment_commands(CommandLine& line) {
    declare_bench(line);
    declare_acquire(line);
}

} // namespace graze
