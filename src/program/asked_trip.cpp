#include "program/asked_trip.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/rounded.hpp"
#include "program/commands.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t most_numbers = 1000;

[[noreturn]] void refuse_trip(const std::string& option, const std::string& text, const std::string& what,
                              const char* example) {
    throw InputError(Place{option + " " + text, 0, 0}, what, example);
}

/// Adds a value for each decade from the first to the last.
void add_decades(std::vector<double>& values, double first, double last, const std::string& option,
                 const std::string& text) {
    if (!(first * last > 0))
        refuse_trip(option, text, "the ends of the range are not of one sign", "write 1e-3,1e-6 or 1e-2:1e-20");
    const double decades = std::abs(std::log10(first / last));
    if (!(decades < most_numbers))
        refuse_trip(option, text, "the range is too long", "write 1e-3,1e-6 or 1e-2:1e-20");
    const auto count = static_cast<int>(std::floor(decades + 1e-9));
    constexpr int decimals = 15; // so that powers of ten are what people write
    for (int i = 0; i <= count; ++i) {
        const long double decade = std::pow(10.0L, std::abs(first) > std::abs(last) ? -i : i);
        values.push_back(rounded(static_cast<double>(first * decade), decimals));
    }
}

NamedEnd end_of(const LossPoint& point, const TripArguments& arguments) {
    if (arguments.greatest_speed)
        return end_at_speed(point, *arguments.greatest_speed);
    if (arguments.until == "end")
        return {{}, "the end", true};
    if (arguments.until.empty())
        return usual_end(point);
    const std::size_t equals = arguments.until.rfind('=');
    if (equals == std::string::npos)
        throw InputError(Place{"--until " + arguments.until, 0, 0}, "it names no level",
                         "write EXPR=LEVEL, such as q=0.9, or end");
    NamedEnd asked{{}, arguments.until, true};
    asked.end.quantity = requested_quantity(point.model(), arguments.until.substr(0, equals), "--until").value;
    asked.end.level = value_of(point.model(), arguments.until.substr(equals + 1), "--until");
    return asked;
}

} // namespace

AskedTrip asked_trip(const ResultFile& file, const std::string& point, const TripArguments& arguments,
                     const std::string& option) {
    const Place place{option, 0, 0};
    StoredOrbit stored = find_stored_orbit(file, point, place);
    LossPoint loss = loss_point(stored, arguments.parameter, place, {"--parameter", 0, 0});
    NamedEnd end = end_of(loss, arguments);
    return {std::move(stored), std::move(loss), std::move(end)};
}

std::vector<double> numbers_by_decades(const Model& model, const std::vector<std::string>& asked,
                                       const std::string& option) {
    std::vector<double> values;
    for (const std::string& text : split_list(asked)) {
        const std::size_t colon = text.find(':');
        const auto number = [&](const std::string& part) { return value_of(model, part, option); };
        if (colon == std::string::npos)
            values.push_back(number(text));
        else
            add_decades(values, number(text.substr(0, colon)), number(text.substr(colon + 1)), option, text);
    }
    if (values.size() > most_numbers)
        refuse_trip(option, "", fmt::format("{} numbers are too many", values.size()), "write 1e-3,1e-6 or 1e-2:1e-20");
    return values;
}

std::string why_not(const TripTime& trip, const std::string& longer) {
    if (!trip.detail.empty())
        return trip.detail;
    if (trip.ending == "end-time")
        return fmt::format("it has been simulated for {:.6g} cycles; {}", trip.cycles, longer);
    return fmt::format("it ended by {}", trip.ending);
}

void tell_lacks(const std::vector<std::string>& lacks, const Console& console) {
    constexpr std::size_t most = 5;
    for (std::size_t i = 0; i < std::min(most, lacks.size()); ++i)
        console.err << fmt::format("graze: {}\n", lacks[i]);
    if (lacks.size() > most)
        console.err << fmt::format("graze: {} more are like that\n", lacks.size() - most);
}

JsonObject heading_of(const ResultFile& file, const AskedTrip& asked) {
    const LossPoint& point = asked.point;
    JsonObject heading = heading_of_point(file, asked.stored);
    heading.add("parameter", point.name);
    heading.add(point.kind(), point.value);
    heading.add("cycle", point.cycle);
    if (point.fold) {
        heading.add("coefficient", point.fold->coefficient);
        heading.add("rate", point.fold->rate);
    } else {
        heading.add("speed", level_until(point, asked.end.end));
    }
    heading.add("end", asked.end.words);
    return heading;
}

} // namespace graze
