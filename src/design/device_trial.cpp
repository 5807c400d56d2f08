#include "graze/design/device_trial.hpp"

#include "graze/base/input_error.hpp"
#include "graze/branch/orbit_branch.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Counts contacts with the touched surface.
class ContactCount : public Observer {
public:
    ContactCount(std::size_t event, const std::function<bool()>& interrupted)
        : event_(event), interrupted_(&interrupted) {}
    void contact(const Contact& contact) override {
        contacts_ += contact.event == event_ && contact.kind == ContactKind::crossing ? 1 : 0;
    }
    bool stop() override { return *interrupted_ && (*interrupted_)(); }
    std::size_t contacts() const { return contacts_; }

private:
    std::size_t event_;
    const std::function<bool()>* interrupted_;
    std::size_t contacts_ = 0;
};

/// Number of contacts of an orbit with an event in one period.
std::size_t own_contacts(const Model& model, const Orbit& whole, std::size_t event) {
    return static_cast<std::size_t>(std::ranges::count_if(whole.signature, [&](const Segment& s) {
        return ends_by_transition(s) && model.transitions[s.index].event == event;
    }));
}

/// Continues the branch of a fold to the side of stable orbits, until the control parameter has a value. @return the
/// fold itself if neither side is stable
Orbit before_fold(const TripPoint& trip, const Orbit& orbit, double value) {
    constexpr double first = 1e-3; // relative to the sizes of the unknowns
    constexpr std::size_t most = 100;
    for (const int way : {1, -1}) {
        OrbitDirection along = trip.point.tangent;
        const auto turn = [&](std::vector<double>& numbers) {
            for (double& number : numbers)
                number *= way;
        };
        std::ranges::for_each(along.starts, turn);
        turn(along.durations);
        turn(along.parameters);
        BranchSettings settings;
        settings.parameter = trip.control;
        settings.steps = most;
        settings.orbit.error_estimate = false;
        OrbitBranch branch(trip.system, orbit, settings);
        if (!branch.start_along(along, first))
            continue;
        do {
            const BranchPoint& point = branch.point();
            if (!point.stable)
                break;
            if ((value - point.parameter) * trip.fold_side >= 0)
                return point.solution.orbit;
        } while (branch.step());
    }
    return orbit;
}

/// Checks that the orbit below the trip point exists, and that the motion remains on it.
void try_below(DeviceTrial& trial, const TripPoint& trip, const Orbit& orbit, const DeviceTrialOptions& options) {
    OrbitOptions numbers;
    numbers.error_estimate = false;
    const bool fold = trip.point.type == PointType::fold;
    Orbit candidate = fold ? before_fold(trip, orbit, trial.below) : orbit;
    // Near a fold there are two orbits: use the stable one at the value where it was found.
    if (fold)
        trial.below = candidate.parameters[trip.control.place()];
    candidate.parameters[trip.control.place()] = trial.below;
    const OrbitSolution solution = solve_orbit(trip.system, candidate, numbers);
    if (solution.outcome != OrbitOutcome::converged) {
        trial.seen_below = "no orbit was found: " + solution.detail;
        return;
    }
    if (!solution.certificate.admissible || !is_stable(solution)) {
        trial.seen_below = solution.certificate.admissible
                               ? "the orbit is not stable"
                               : "the orbit is not admissible: " + solution.certificate.reason;
        return;
    }
    const Orbit whole = whole_orbit(trip.system, solution.orbit);
    SimulationOptions simulated;
    const Simulation simulation(trip.system, {}, {}, simulated);
    ContactCount count(trip.point.event, options.interrupted);
    Trajectory trajectory(simulation, whole.parameters, borrowed(count));
    trajectory.start(whole.starts.front(), whole.signature.front().mode, 0,
                     static_cast<double>(options.cycles) * whole.period());
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    const Outcome& outcome = trajectory.outcome();
    if (outcome.ending != Ending::end_time) {
        trial.seen_below = fmt::format("the motion ended at {:.6g}: {}", outcome.time, name_of(outcome.ending));
        return;
    }
    const std::size_t own = trip.is_touch()
                                ? options.cycles * own_contacts(trip.system.model(), whole, trip.point.event)
                                : count.contacts();
    // A contact at either end of the simulated time may or may not be counted.
    const bool as_many =
        count.contacts() <= own + 1 && count.contacts() + 1 >= own && (own > 0 || count.contacts() == 0);
    trial.rests_below = as_many;
    trial.seen_below =
        as_many ? fmt::format("a stable motion for {} periods, without any touch of another kind", options.cycles)
                : fmt::format("{} contacts in {} periods", count.contacts(), options.cycles);
}

/// Simulates the motion from the orbit at the trip point, above the trip value, until an end.
TripTime tripping(const DeviceTrial& trial, const TripPoint& trip, const Orbit& orbit, const TripEnd& end,
                  double cycles, const DeviceTrialOptions& options) {
    TripOptions numbers;
    numbers.cycles = cycles;
    numbers.interrupted = options.interrupted;
    std::vector<double> parameters = orbit.parameters;
    parameters[trip.control.place()] = trial.above;
    return simulate_until(trip.system, parameters, orbit.starts.front(), orbit.signature.front().mode, orbit.period(),
                          end, numbers);
}

void try_above(DeviceTrial& trial, const TripPoint& trip, const Orbit& orbit, const TripRequest& request,
               const DeviceTrialOptions& options) {
    trial.trip = tripping(trial, trip, orbit, request.end, request.cycles, options);
    trial.trips_above = trial.trip.ended;
    trial.seen_above = trial.trip.ended
                           ? fmt::format("{} after {:.6g} periods", trial.trip.ending, trial.trip.cycles)
                           : fmt::format("no trip within {:.6g} periods ({})", trial.trip.cycles, trial.trip.ending);
}

/// Whether a motion that has not reached the end that counts as tripped leaves the class undecided.
/// @return why, and what to do; empty if it decides the class
std::string undecided_above(const DeviceTrial& trial, const TripPoint& trip, const Orbit& orbit, const TripClass& found,
                            const TripRequest& request, const DeviceTrialOptions& options) {
    if (trial.trip.ending != name_of(Ending::end_time))
        return trial.trip.detail.empty() ? "the simulation ended by " + trial.trip.ending : trial.trip.detail;
    const std::string longer =
        fmt::format("give more trip.cycles than {:g}, or another end by trip.until", request.cycles);
    if (!trip.is_touch())
        return "no orbit is left beyond the fold, but the end that counts as tripped has not come in time; " + longer;
    if (!found.map || !found.map->exists() || !found.map->clearance_rate || *found.map->clearance_rate == 0)
        return "";
    PredictionOptions prediction;
    prediction.level = level_of_map(*found.map, found.verdict);
    const PredictedTrip predicted = predicted_trip(*found.map, found.verdict, trial.above - trip.value(), prediction);
    constexpr double enough = 2; // times the prediction of the map
    const double wait = enough * predicted.cycles + 1;
    if (predicted.ended && wait > request.cycles)
        return fmt::format("by the map contacts become hard after {:.6g} cycles only; {}", predicted.cycles, longer);
    const TripTime grown =
        tripping(trial, trip, orbit, {.speed = prediction.level, .quantity = {}, .level = 0}, request.cycles, options);
    if (grown.ended)
        return fmt::format("contacts have become harder than the map describes, {:.6g}, after {:.6g} cycles, but the "
                           "end that counts as tripped has not come in time; {}",
                           prediction.level, grown.cycles, longer);
    return "";
}

} // namespace

DeviceTrial try_device(const TripPoint& trip, const Orbit& orbit, const TripClass& found, const TripRequest& request,
                       const DeviceTrialOptions& options) {
    if (!(options.share > 0 && options.share < 1))
        throw InputError(fmt::format("the share {} is out of range", options.share), "choose one between 0 and 1");
    DeviceTrial trial;
    const double value = orbit.parameters[trip.control.place()];
    const double way = options.share * (value != 0 ? std::abs(value) : 1) * (found.verdict.side < 0 ? -1 : 1);
    trial.below = value - way;
    trial.above = value + way;
    try_below(trial, trip, orbit, options);
    try_above(trial, trip, orbit, request, options);
    if (found.outcome == GrazingOutcome::undecided) {
        trial.outcome = TrialOutcome::undecided;
        trial.reason = "there is no class to compare with";
        return trial;
    }
    const bool fold = !trip.is_touch() && found.outcome == GrazingOutcome::folds;
    const bool expected = found.outcome == GrazingOutcome::lost || fold;
    if (trial.rests_below && expected && !trial.trips_above)
        trial.reason = undecided_above(trial, trip, orbit, found, request, options);
    if (!trial.reason.empty()) {
        trial.outcome = TrialOutcome::undecided;
        return trial;
    }
    trial.outcome =
        trial.rests_below && trial.trips_above == expected ? TrialOutcome::agreed : TrialOutcome::contradicted;
    return trial;
}

} // namespace graze
