#include "program/identify_kinds.hpp"

#include "graze/base/input_error.hpp"
#include "program/record_stages.hpp"
#include "program/with_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace graze {

namespace {

/// VALUE or VALUE+-ERROR
Estimate known_value(const std::string& text, const char* option) {
    const std::size_t sign = text.find("+-");
    const auto number = [&](const std::string& part) {
        double value = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(value))
            throw InputError(Place{fmt::format("{} {}", option, text), 0, 0}, fmt::format("'{}' is no number", part),
                             "write a value, or a value and its standard error as in 1.9e-5+-2e-7");
        return value;
    };
    return {number(text.substr(0, sign)), sign == std::string::npos ? 0 : std::abs(number(text.substr(sign + 2))), 0};
}

IdentificationSettings settings_of(const IdentifyArguments& arguments) {
    IdentificationSettings settings;
    settings.asked_as = "--";
    if (!arguments.channel.empty())
        settings.channel = arguments.channel;
    settings.displacement = arguments.displacement;
    if (!arguments.voltage.empty())
        settings.voltage = arguments.voltage;
    if (!arguments.current.empty())
        settings.current = arguments.current;
    settings.peaks = arguments.peaks;
    settings.window = arguments.window;
    settings.transition = arguments.transition;
    settings.least_jump = arguments.least_jump;
    settings.gap = arguments.gap;
    settings.gap_error = arguments.gap_error;
    settings.stiffness = arguments.stiffness;
    settings.stiffness_error = arguments.stiffness_error;
    if (!arguments.noise.empty()) {
        settings.displacement_noise = arguments.noise[0];
        settings.current_noise = arguments.noise[1];
    }
    settings.frequency = arguments.frequency;
    if (!arguments.beta1.empty())
        settings.beta1 = known_value(arguments.beta1, "--beta1");
    if (!arguments.beta2.empty())
        settings.beta2 = known_value(arguments.beta2, "--beta2");
    settings.clamped = arguments.clamped;
    return settings;
}

} // namespace

Identification identify_from_files(const IdentifyArguments& arguments, const Console& console) {
    const EachRecord records = [&](const auto& work) {
        for (const std::string& file : arguments.reading.files)
            with_file(file, [&] {
                RecordStages stages(file, arguments.reading, console);
                work(file, stages.source());
            });
    };
    const IdentificationSettings settings = settings_of(arguments);
    if (arguments.what == "decrement")
        return identify_decrement(records, settings);
    if (arguments.what == "restitution")
        return identify_restitution(records, settings);
    return arguments.what == "coupling" ? identify_coupling(records, settings) : identify_impedance(records, settings);
}

} // namespace graze
