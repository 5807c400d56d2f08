#include "graze/trip/trip_request.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/rounded.hpp"
#include "graze/model/named_value.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

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

} // namespace

std::vector<double> numbers_by_decades(const Model& model, const std::vector<std::string>& items,
                                       const std::string& option) {
    std::vector<double> values;
    for (const std::string& text : items) {
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

NamedEnd read_end(const LossPoint& point, const std::string& text, const std::string& option) {
    if (text == "end")
        return {{}, "the end", true};
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos)
        throw InputError(Place{option + " " + text, 0, 0}, "it names no level",
                         "write EXPR=LEVEL, such as q=0.9, or end");
    NamedEnd asked{{}, text, true};
    asked.end.quantity = requested_quantity(point.model(), text.substr(0, equals), option).value;
    asked.end.level = value_of(point.model(), text.substr(equals + 1), option);
    return asked;
}

std::string why_not(const TripTime& trip, const std::string& longer) {
    if (!trip.detail.empty())
        return trip.detail;
    if (trip.ending == "end-time")
        return fmt::format("it has been simulated for {:.6g} cycles; {}", trip.cycles, longer);
    return fmt::format("it ended by {}", trip.ending);
}

std::vector<std::string> unfinished_trips(const OvershootTrips& trips, const std::string& longer) {
    std::vector<std::string> lacks;
    for (std::size_t i = 0; i < trips.size(); ++i)
        if (const TripTime* const unfinished = trips.unfinished(i))
            lacks.push_back(fmt::format("the trip at the overshoot {:g} has not come to its end: {}",
                                        trips.point.fold ? trips.of_fold[i].overshoot : trips.of_touch[i].overshoot,
                                        why_not(*unfinished, longer)));
    return lacks;
}

std::vector<std::string> unfinished_trips(const std::vector<RampRow>& rows, const std::string& longer) {
    std::vector<std::string> lacks;
    for (const RampRow& row : rows)
        if (!row.ramped.trip.ended)
            lacks.push_back(fmt::format("the ramp of {:g} has not come to its end: {}", row.rate,
                                        why_not(row.ramped.trip, longer)));
    return lacks;
}

std::vector<std::string> unfinished_trips(const std::vector<double>& amplitudes, const std::vector<TripTime>& trips) {
    std::vector<std::string> lacks;
    for (std::size_t i = 0; i < trips.size(); ++i)
        if (!(trips[i].ended || trips[i].ending == "end-time"))
            lacks.push_back(
                fmt::format("the wave of {:g} has not been simulated to its end: {}", amplitudes[i],
                            why_not(trips[i], "look at whether the parameter has a meaning as far as it swings")));
    return lacks;
}

std::vector<std::string> unfinished_trips(const std::vector<double>& levels, const std::vector<NoisyTrips>& all) {
    std::vector<std::string> lacks;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (const auto& [ending, count] : all[i].failures)
            lacks.push_back(
                fmt::format("{} of {} motions under the noise {:g} are not counted: they ended by {}; look at whether "
                            "the parameter has a meaning as far as the noise takes it",
                            count, all[i].motions, levels[i], ending));
    return lacks;
}

} // namespace graze
