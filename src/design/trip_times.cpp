#include "graze/design/trip_times.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Simulates the motion from the orbit at the trip point.
TripTime simulated_from_orbit(const TripPoint& trip, const Orbit& orbit, double overshoot, const TripEnd& end,
                              const TripOptions& options) {
    std::vector<double> parameters = orbit.parameters;
    parameters[trip.control.place()] += overshoot;
    return simulate_until(trip.system, parameters, orbit.starts.front(), orbit.signature.front().mode, orbit.period(),
                          end, options);
}

/// Adds the trip times of a fold: the passage by the normal form, and by simulation.
void add_fold_rows(TripTimes& times, const TripPoint& trip, const Orbit& orbit, const TripRequest& request, int side,
                   const TripOptions& options) {
    SpecialPoint point = trip.point;
    point.solution.orbit = orbit;
    std::optional<FoldPassage> fold;
    try {
        fold = fold_passage(trip.system, point, trip.control);
    } catch (const InputError&) { // no normal form could be computed: only simulation remains
    }
    const double value = orbit.parameters[trip.control.place()];
    constexpr double digits = 1e-12; // relative accuracy of the parameter at a fold
    for (const double overshoot : overshoots_of(request, value, side)) {
        if (options.interrupted && options.interrupted())
            return;
        OvershootTrip& row = times.rows.emplace_back();
        row.overshoot = overshoot;
        if (fold && fold->attracting && overshoot * fold->side > 0) {
            PredictedTrip& predicted = row.predicted.emplace();
            predicted.cycles = cycles_of_passage(*fold, overshoot, 0, fold->gate);
            predicted.time = predicted.cycles * fold->cycle;
            predicted.ended = std::isfinite(predicted.time);
            predicted.ending = "passage";
        }
        const bool short_enough = !row.predicted || row.predicted->cycles < options.cycles;
        if (std::abs(overshoot) < digits * std::abs(value) || !short_enough)
            continue;
        row.simulated = simulated_from_orbit(trip, orbit, overshoot, request.end, options);
    }
}

} // namespace

std::vector<double> overshoots_of(const TripRequest& request, double value, int side) {
    const double sign = side < 0 ? -1 : 1;
    std::vector<double> result;
    constexpr double most = 1e3; // relative to the trip value; a larger one is taken for a typing error
    for (const double one : request.overshoots) {
        if (value != 0 && !(one <= most * std::abs(value)))
            throw InputError(request.place,
                             fmt::format("the overshoot {} is {:.3g} times the trip value, {:.6g}", one,
                                         one / std::abs(value), value),
                             "give how far beyond the trip value the control parameter goes, in its unit");
        result.push_back(sign * one);
    }
    return result.empty() ? usual_overshoots(value, side) : result;
}

TripTimes trip_times(const TripPoint& trip, const Orbit& orbit, const TripClass& found, const TripRequest& request,
                     const std::function<bool()>& interrupted) {
    TripTimes times;
    TripOptions options;
    options.cycles = request.cycles;
    options.interrupted = interrupted;
    const double value = orbit.parameters[trip.control.place()];
    if (trip.point.type == PointType::fold) {
        add_fold_rows(times, trip, orbit, request, found.verdict.side, options);
        return times;
    }
    if (found.outcome != GrazingOutcome::lost) {
        times.reason = found.outcome == GrazingOutcome::persists ? "the motion persists beyond the touch: nothing trips"
                       : found.outcome == GrazingOutcome::folds
                           ? "the orbit goes on beyond the touch, to a fold: design for that point"
                           : "it is not known whether the motion is lost: " + found.reason;
        return times;
    }
    const bool mapped = found.map && found.map->exists() && found.map->clearance_rate &&
                        *found.map->clearance_rate != 0 && found.verdict.side != 0;
    const double level = mapped ? level_of_map(*found.map, found.verdict) : 0;
    for (const double overshoot : overshoots_of(request, value, found.verdict.side)) {
        if (interrupted && interrupted())
            break;
        if (mapped) {
            times.rows.push_back(trip_of_touch(trip.system, *found.map, found.verdict, trip.control, overshoot,
                                               request.end.speed > 0 ? std::min(level, request.end.speed) : level,
                                               request.end, options));
        } else { // the contact itself ends the motion
            OvershootTrip& row = times.rows.emplace_back();
            row.overshoot = overshoot;
            row.simulated = simulated_from_orbit(trip, orbit, overshoot, request.end, options);
        }
    }
    return times;
}

} // namespace graze
