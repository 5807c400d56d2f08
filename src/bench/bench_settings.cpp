#include "graze/bench/bench_settings.hpp"

#include "graze/base/file_name.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

constexpr std::size_t most_channels = 64;
constexpr int most_bits = 32;

void require_positive(double value, const char* what) {
    if (!(value > 0) || !std::isfinite(value))
        throw InputError(fmt::format("{} is {}", what, value), "give a positive number");
}

void require_not_negative(double value, const std::string& channel, const char* what) {
    if (!(value >= 0) || !std::isfinite(value))
        throw InputError(fmt::format("the {} of channel '{}' is {}", what, channel, value), "give 0 or more");
}

} // namespace

void BenchSettings::validate() const {
    require_positive(time_unit, "the unit of the model's time");
    if (channels.empty() || channels.size() > most_channels)
        throw InputError(fmt::format("the bench has {} channels", channels.size()),
                         fmt::format("give from 1 to {}", most_channels));
    for (const BenchChannel& channel : channels) {
        require_finite(channel.offset, "the offset of a channel");
        require_finite(channel.drift, "the drift of a channel");
        require_not_negative(channel.noise, channel.value.name, "noise");
        require_not_negative(channel.range, channel.value.name, "range");
        if (std::count_if(channels.begin(), channels.end(),
                          [&](const BenchChannel& other) { return other.value.name == channel.value.name; }) > 1)
            throw InputError(fmt::format("there are two channels '{}'", channel.value.name), "give each its own name");
    }
    if (bits < 1 || bits > most_bits)
        throw InputError(fmt::format("a converter of {} bits is out of range", bits),
                         fmt::format("give from 1 to {}", most_bits));
    if (!(anti_alias >= 0) || !std::isfinite(anti_alias))
        throw InputError(fmt::format("the corner of the filter is {}", anti_alias), "give a frequency, or 0 for none");
    require_positive(tolerance, "the tolerance");
}

std::vector<std::string> usual_channels(const Model& model) {
    std::vector<std::string> texts;
    if (const auto voltage = model.find_quantity("voltage"))
        texts.push_back(fmt::format("V=voltage:{}", model.quantities[*voltage].unit));
    for (const State& state : model.states)
        if (!state.period)
            texts.push_back(state.unit.empty() ? state.name : fmt::format("{0}={0}:{1}", state.name, state.unit));
    return texts;
}

BenchChannel bench_channel(const Model& model, const std::string& text, const std::string& asked) {
    const Place place{asked, 0, 0};
    const std::size_t equals = text.find('='), colon = text.rfind(':');
    const bool has_unit = colon != std::string::npos && (equals == std::string::npos || colon > equals);
    const std::string before = text.substr(0, has_unit ? colon : text.size());
    const std::string expression = equals == std::string::npos ? before : before.substr(equals + 1);
    BenchChannel channel;
    channel.value = named_value(model, expression, Place{asked + " " + text, 0, 0});
    if (equals != std::string::npos)
        channel.value.name = text.substr(0, equals);
    if (has_unit)
        channel.value.unit = text.substr(colon + 1);
    if (!is_file_name(channel.value.name))
        throw InputError(place, fmt::format("'{}' cannot be the name of a channel", channel.value.name),
                         "write NAME=EXPRESSION with a name of letters and digits");
    require_plain_line(channel.value.unit, "unit of a channel", place);
    if (channel.value.unit.find_first_of("[](),;\t ") != std::string::npos)
        throw InputError(place, fmt::format("'{}' cannot be the unit of a channel", channel.value.unit),
                         "leave out brackets, separators and blanks");
    return channel;
}

DrivenInput driven_input(const Model& model, const std::string& text, const std::string& asked) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string name = text.substr(0, equals);
    DrivenInput input;
    try {
        input.parameter = model.independent_parameter(name);
    } catch (const InputError& error) {
        throw InputError(Place{asked, 0, 0}, error.problem(), error.remedy());
    }
    if (equals < text.size())
        input.factor = value_of_text(model, text.substr(equals + 1), Place{asked + " " + text, 0, 0});
    return input;
}

} // namespace graze
