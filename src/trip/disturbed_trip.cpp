#include "graze/trip/disturbed_trip.hpp"

#include "graze/base/input_error.hpp"
#include "graze/model/driven_parameter.hpp"
#include "trip/end_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace graze {

namespace {

/// Simulates a motion from the origin in a model whose parameter varies in time.
TripTime follow_disturbed(const TripOrigin& origin, const DrivenParameter& driven, const std::vector<double>& further,
                          double longest, const TripEnd& end, const TripOptions& options) {
    TripEnd here = end;
    if (end.quantity)
        here.quantity = driven.of(*end.quantity);
    const Simulation simulation = simulation_until(System(driven.model), here, options);
    std::vector<double> parameters = origin.parameters, state = origin.state;
    parameters.insert(parameters.end(), further.begin(), further.end());
    state.push_back(0);
    const auto counts = [&](const Contact& contact) { return origin.counts(contact); };
    EndWatch watch(here, counts, options.interrupted);
    TripTime trip = run_until(simulation, parameters, state, origin.mode, longest, watch);
    trip.cycles = trip.time / origin.cycle;
    return trip;
}

const std::string name_of_origin(const System& system, const TripOrigin& origin) {
    return system.model().independent_parameters().at(origin.parameter.place());
}

TripOrigin origin_of_ramp(const LossPoint& point, double from, bool given) {
    try {
        return trip_origin(point, from);
    } catch (const InputError& error) {
        if (given)
            throw InputError(Place{"at", 0, 0}, error.problem(), error.remedy());
        throw InputError(Place{"ramp", 0, 0},
                         fmt::format("the ramp would begin at {} = {:.6g}: {}", point.name, from, error.problem()),
                         "give a slower one, or say where it begins: at VALUE");
    }
}

} // namespace

double beginning_of_ramp(const LossPoint& point, double rate) {
    constexpr double cycles = 100, delays = 5, resolvable = 10;
    double distance = cycles * std::abs(rate) * point.cycle;
    if (point.fold)
        distance = std::max(distance, delays * std::abs(delay_of_ramp(*point.fold, rate)));
    const double least = point.fold ? least_overshoot(*point.fold) : least_overshoot(point.map, point.parameter);
    return point.value - point.side * std::max(distance, resolvable * least);
}

RampedTrip ramped_trip(const System& system, const TripOrigin& origin, double rate, const TripEnd& end,
                       const TripOptions& options) {
    options.validate();
    const double distance = origin.point - origin.value;
    if (!(rate * distance > 0 && std::isfinite(rate)))
        throw InputError(fmt::format("with the rate {} the parameter does not come to the point", rate),
                         distance > 0 ? "give a positive rate" : "give a negative rate");
    const DrivenParameter driven = drive_parameter(system.model(), name_of_origin(system, origin), DriveKind::shift);
    RampedTrip result;
    result.trip =
        follow_disturbed(origin, driven, {rate}, distance / rate + options.cycles * origin.cycle, end, options);
    result.value = origin.value + rate * result.trip.time;
    return result;
}

double delay_of_ramp(const FoldPassage& fold, double rate) {
    constexpr double first_zero = 2.338107410459767; // magnitude of the first zero of the Airy function
    const double of_cycle = std::abs(rate) * fold.cycle;
    return std::copysign(first_zero, rate) * std::pow(of_cycle, 2.0 / 3) /
           std::cbrt(fold.coefficient * std::abs(fold.rate));
}

TripTime swung_trip(const System& system, const TripOrigin& origin, double amplitude, double period, const TripEnd& end,
                    const TripOptions& options) {
    options.validate();
    if (!(period > 0 && std::isfinite(period)) || !std::isfinite(amplitude))
        throw InputError(
            fmt::format("a wave with the amplitude {} and the period {} is not possible", amplitude, period),
            "give finite numbers, and a positive period");
    const DrivenParameter driven = drive_parameter(system.model(), name_of_origin(system, origin), DriveKind::wave);
    return follow_disturbed(origin, driven, {2 * std::numbers::pi / period, amplitude}, options.cycles * origin.cycle,
                            end, options);
}

std::vector<RampRow> ramped_trips(const LossPoint& point, const std::vector<double>& rates, std::optional<double> from,
                                  const TripEnd& end, const TripOptions& options) {
    std::vector<RampRow> rows;
    for (const double rate : rates) {
        if (!(rate * point.side > 0))
            throw InputError(fmt::format("with the rate {} the parameter does not come to the point from where the "
                                         "motion is at rest",
                                         rate),
                             point.side > 0 ? "give a positive rate" : "give a negative rate");
        RampRow row{rate, from ? *from : beginning_of_ramp(point, rate), {}, {}, {}};
        row.ramped = ramped_trip(point.system, origin_of_ramp(point, row.from, from.has_value()), rate, end, options);
        if (options.interrupted && options.interrupted())
            break;
        if (row.ramped.trip.ended)
            row.delay = row.ramped.value - point.value;
        if (point.fold)
            row.predicted_delay = delay_of_ramp(*point.fold, rate);
        rows.push_back(std::move(row));
    }
    return rows;
}

std::vector<TripTime> swung_trips(const LossPoint& point, const TripOrigin& origin,
                                  const std::vector<double>& amplitudes, double period, const TripEnd& end,
                                  const TripOptions& options) {
    std::vector<TripTime> trips;
    for (const double amplitude : amplitudes) {
        TripTime trip = swung_trip(point.system, origin, amplitude, period, end, options);
        if (options.interrupted && options.interrupted())
            break;
        trips.push_back(std::move(trip));
    }
    return trips;
}

} // namespace graze
