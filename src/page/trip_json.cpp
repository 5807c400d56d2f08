#include "page/trip_json.hpp"

#include "graze/picture/trip_series.hpp"
#include "graze/results/touching_orbit.hpp"
#include "graze/results/trip_table.hpp"
#include "graze/trip/trip_request.hpp"
#include "page/figure_json.hpp"
#include "page/json_text.hpp"
#include "page/stored_point.hpp"
#include "page/table_json.hpp"
#include "page/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr double usual_cycles = 2000, most_cycles = 1e6;
constexpr std::size_t most_overshoots = 50, most_notes = 5;

TripOptions trip_options(const TripWish& wish) {
    TripOptions options;
    options.cycles = wish.cycles.value_or(usual_cycles);
    if (!(options.cycles >= 1 && options.cycles <= most_cycles))
        throw InputError({"cycles", 0, 0}, fmt::format("{} cycles are out of range", options.cycles),
                         fmt::format("give 1 to {:g}", most_cycles));
    options.interrupted = time_limit(wish.most_seconds, wish.interrupted);
    return options;
}

std::vector<double> wished_overshoots(const LossPoint& point, const TripWish& wish) {
    std::vector<double> values = numbers_by_decades(point.model(), wish.overshoots, "overshoots");
    if (values.empty())
        return usual_overshoots(point.value, point.side);
    if (values.size() > most_overshoots)
        throw InputError({"overshoots", 0, 0}, fmt::format("{} overshoots are asked for", values.size()),
                         fmt::format("ask for {} at most", most_overshoots));
    if (std::ranges::find(values, 0.0) != values.end())
        throw InputError({"overshoots", 0, 0}, "an overshoot of zero has no place on a logarithmic axis",
                         "leave it out");
    return values;
}

/// What the point and the end of the trips are.
std::string words_of_trips(const OvershootTrips& trips) {
    const LossPoint& point = trips.point;
    return fmt::format("{} at {} = {:.10g}{}{}, trips until {}", point.kind(), point.name, point.value,
                       point.unit.empty() ? "" : " ", point.unit, trips.end.words);
}

nlohmann::json notes_of_trips(const OvershootTrips& trips, std::size_t asked) {
    nlohmann::json list = nlohmann::json::array();
    if (trips.interrupted)
        list.push_back(fmt::format("{} of {} overshoots were computed in the time given", trips.size(), asked));
    const std::vector<std::string> lacks = unfinished_trips(trips, "ask for more cycles, or for another end");
    for (std::size_t i = 0; i < std::min(most_notes, lacks.size()); ++i)
        list.push_back(lacks[i]);
    if (lacks.size() > most_notes)
        list.push_back(fmt::format("{} more are like that", lacks.size() - most_notes));
    return list;
}

} // namespace

nlohmann::json trip_json(const ResultFile& file, const std::string& run, std::size_t number, const TripWish& wish) {
    const StoredRun of(file, run, {});
    const StoredOrbit stored{of, orbit_numbered(of, number)};
    const LossPoint point = loss_point(stored, wish.parameter, {}, {"parameter", 0, 0});
    const NamedEnd end = wish.until.empty() ? usual_end(point) : read_end(point, wish.until, "until");
    const std::vector<double> overshoots = wished_overshoots(point, wish);
    const OvershootTrips trips = overshoot_trips(point, end, overshoots, trip_options(wish));
    nlohmann::json one{{"run", run}, {"number", number}, {"parameter", point.name}, {"end", end.words}};
    one["value"] = number_json(point.value);
    one["cycle"] = number_json(point.cycle);
    one["complete"] = !trips.interrupted;
    one["words"] = words_of_trips(trips);
    one["notes"] = notes_of_trips(trips, overshoots.size());
    one["table"] = table_json("trips", trip_table(trips));
    one["figure"] = trips.size() > 0 ? figure_json(trip_figure({trips})) : nlohmann::json();
    return one;
}

} // namespace graze
