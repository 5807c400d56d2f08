#include "graze/base/input_error.hpp"
#include "graze/model/catalogue.hpp"
#include "instrument/bench_service.hpp"
#include "program/commands.hpp"
#include "program/interrupt.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

/// Sets a property of channels from texts NAME=VALUE.
void set_each(BenchSettings& settings, const std::vector<std::string>& texts, const char* option,
              double BenchChannel::*property) {
    std::vector<std::string> names;
    for (const BenchChannel& channel : settings.channels)
        names.push_back(channel.value.name);
    for (const std::string& text : split_list(texts)) {
        const std::size_t equals = std::min(text.find('='), text.size());
        const auto found = std::find(names.begin(), names.end(), text.substr(0, equals));
        if (equals == text.size())
            throw InputError(Place{option, 0, 0}, fmt::format("'{}' gives no value", text), "write NAME=VALUE");
        if (found == names.end())
            throw InputError(Place{option, 0, 0}, fmt::format("there is no channel '{}'", text.substr(0, equals)),
                             name_advice(text.substr(0, equals), names, ""));
        settings.channels[static_cast<std::size_t>(found - names.begin())].*property =
            value_of(settings.model, text.substr(equals + 1), option);
    }
}

BenchSettings bench_settings(const BenchArguments& arguments) {
    BenchSettings settings;
    settings.model = load_model(arguments.model);
    Model& model = settings.model;
    set_parameters(model, arguments.set);
    set_initial_state(model, arguments.from);
    settings.amplitude = driven_input(model, arguments.amplitude, "--amplitude");
    settings.frequency = driven_input(model, arguments.frequency, "--frequency");
    if (!arguments.offset.empty())
        settings.offset = driven_input(model, arguments.offset, "--offset");
    settings.time_unit = arguments.time_unit;
    for (const std::string& text : arguments.channels.empty() ? usual_channels(model) : arguments.channels)
        settings.channels.push_back(bench_channel(model, text, "--channel"));
    set_each(settings, arguments.noise, "--noise", &BenchChannel::noise);
    set_each(settings, arguments.bias, "--bias", &BenchChannel::offset);
    set_each(settings, arguments.drift, "--drift", &BenchChannel::drift);
    set_each(settings, arguments.range, "--range", &BenchChannel::range);
    settings.bits = arguments.bits;
    settings.anti_alias = arguments.anti_alias;
    settings.seed = arguments.seed;
    return settings;
}

} // namespace

int bench_command(const BenchArguments& arguments, const Console& console) {
    if (arguments.port.empty())
        throw InputError("the serial line has no name", "give one by --port PATH");
    GeneratorSettings generator;
    if (arguments.clip)
        generator.clip = *arguments.clip;
    generator.left_as = arguments.left_as;
    ScpiBench bench(bench_settings(arguments), generator);
    ServiceSettings settings;
    settings.port = arguments.port;
    settings.tcp = static_cast<std::uint16_t>(arguments.tcp);
    settings.speed = arguments.speed;
    settings.on_demand = arguments.on_demand;
    settings.drop = arguments.drop;
    settings.delay = arguments.delay;
    settings.lines = arguments.break_after;
    settings.broken = arguments.break_for;
    settings.rows = arguments.break_samples;
    settings.seed = arguments.seed;
    const InterruptGuard guard;
    BenchService service(bench, settings);
    // A script may wait for the first line, after which it can connect.
    console.out << fmt::format("generator {}\nsamples tcp:127.0.0.1:{}\n", arguments.port, service.tcp_port())
                << std::flush;
    require_delivered(console);
    service.run([&] { return InterruptGuard::requested(); });
    if (!bench.ended().empty())
        console.err << "graze: " << bench.ended() << '\n';
    return InterruptGuard::exit_code();
}

} // namespace graze
