#include "graze/trip/overshoot_trip.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

const TripTime* OvershootTrip::best() const {
    if (simulated && simulated->ended)
        return &*simulated;
    if (continued && continued->ended)
        return &*continued;
    return nullptr;
}

NamedEnd usual_end(const LossPoint& point) {
    if (point.fold)
        return {{}, "the fold is passed", false};
    return {{point.level, {}, 0}, fmt::format("speed {:.4g}", point.level), false};
}

NamedEnd end_at_speed(const LossPoint& point, double speed) {
    if (point.fold)
        throw InputError(Place{"greatest-speed", 0, 0}, "a fold has no contact of its own",
                         "name a level, until EXPR=LEVEL, or until end");
    return {{speed, {}, 0}, fmt::format("speed {:.4g}", speed), true};
}

double level_until(const LossPoint& point, const TripEnd& end) {
    return end.speed > 0 ? std::min(point.level, end.speed) : point.level;
}

OvershootTrip trip_of_touch(const System& system, const CycleMap& map, const Verdict& verdict, ParameterId parameter,
                            double overshoot, double level, const TripEnd& end, const TripOptions& options) {
    PredictionOptions prediction;
    prediction.level = level;
    prediction.disturbance = options.disturbance;
    OvershootTrip trip;
    trip.overshoot = overshoot;
    trip.predicted = predicted_trip(map, verdict, overshoot, prediction);
    trip.continued = continued_trip(system, map, parameter, overshoot, *trip.predicted, end, options);
    if (overshoot == 0 || std::abs(overshoot) >= least_overshoot(map, parameter))
        trip.simulated = simulated_trip(system, map, parameter, overshoot, end, options);
    return trip;
}

FoldTrip trip_of_fold(const System& system, const FoldPassage& fold, double overshoot, const TripEnd& end,
                      bool until_passed, const TripOptions& options) {
    FoldTrip trip{overshoot, cycles_of_passage(fold, overshoot),
                  cycles_of_passage(fold, overshoot, -fold.gate, fold.gate), std::nullopt};
    if (trip.cycles < options.cycles && std::abs(overshoot) >= least_overshoot(fold))
        trip.passage = simulated_passage(system, fold, overshoot, end, until_passed, options);
    return trip;
}

std::vector<TripSummary> OvershootTrips::summaries() const {
    const auto if_ended = [](const TripTime& trip, double value) { return trip.ended ? value : not_a_number; };
    std::vector<TripSummary> result;
    for (const OvershootTrip& trip : of_touch)
        result.push_back({trip.overshoot, if_ended(*trip.predicted, trip.predicted->cycles),
                          if_ended(*trip.predicted, trip.predicted->time),
                          if_ended(*trip.continued, trip.continued->time)});
    for (const FoldTrip& trip : of_fold) {
        TripSummary& one =
            result.emplace_back(TripSummary{trip.overshoot, trip.cycles, trip.cycles * point.cycle, not_a_number});
        if (trip.passage && end.given)
            one.end_time = if_ended(trip.passage->trip, trip.passage->trip.time);
        else if (trip.passage && trip.passage->passed)
            one.end_time = trip.passage->time;
    }
    return result;
}

const TripTime* OvershootTrips::unfinished(std::size_t index) const {
    require_index(index, size(), "trip");
    if (!point.fold) {
        const TripTime& trip = *of_touch[index].continued;
        return trip.ended ? nullptr : &trip;
    }
    const std::optional<SimulatedPassage>& passage = of_fold[index].passage;
    return !passage || (end.given ? passage->trip.ended : passage->passed) ? nullptr : &passage->trip;
}

OvershootTrips overshoot_trips(const LossPoint& point, const NamedEnd& end, const std::vector<double>& overshoots,
                               const TripOptions& options) {
    if (point.fold && !options.disturbance.empty())
        throw InputError(Place{"disturbance", 0, 0}, "a passage through a fold begins before it",
                         "leave it out, or choose a touch (GR)");
    OvershootTrips trips{point, end};
    for (const double overshoot : overshoots) {
        if (point.fold)
            trips.of_fold.push_back(trip_of_fold(point.system, *point.fold, overshoot, end.end, !end.given, options));
        else
            trips.of_touch.push_back(trip_of_touch(point.system, point.map, point.verdict, point.parameter, overshoot,
                                                   level_until(point, end.end), end.end, options));
        trips.interrupted = options.interrupted && options.interrupted();
        if (!trips.interrupted)
            continue;
        point.fold ? trips.of_fold.pop_back() : trips.of_touch.pop_back();
        break;
    }
    return trips;
}

} // namespace graze
