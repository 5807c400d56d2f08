#pragma once

#include "base/concatenated.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "graze/trip/simulated_trip.hpp"
#include "orbit/newton.hpp"

#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Detects the end of a trip: a contact of a given approach speed, or the level of a quantity.
class EndWatch : public Observer {
public:
    using Counts = std::function<bool(const Contact&)>;
    /// @param counts tells which contacts count; empty: none
    EndWatch(const TripEnd& end, Counts counts, const std::function<bool()>& interrupted)
        : counts_(std::move(counts)), speed_limit_(end.speed), interrupted_(interrupted), level_(end) {}

    /// Must be called before the trajectory starts. @param system of its model; @param parameters of the trajectory
    void begin(const System& system, std::span<const double> parameters) {
        level_.system.emplace(system);
        level_.parameters.assign(parameters.begin(), parameters.end());
    }

    void contact(const Contact& contact) override {
        if (contact.kind == ContactKind::crossing && !is_over(contact.time) && level_.is_reached(contact.before))
            note("level", contact.time);
        if (contact.kind != ContactKind::crossing || !counts_ || !counts_(contact) || is_over(contact.time))
            return;
        ++contacts_;
        speed_ = -contact.rate_before;
        if (speed_limit_ > 0 && speed_ >= speed_limit_)
            note("speed", contact.time);
    }
    void passage(const Passage& passage) override {
        if (passage.probe == 0 && !is_over(passage.time))
            note("level", passage.time);
    }
    bool stop() override { return !ending_.empty() || (interrupted_ && interrupted_()); }

    /// Returns the result for a trajectory that was run with this observer.
    TripTime trip(const Outcome& outcome) const {
        TripTime trip;
        trip.ended = !ending_.empty() || outcome.ending == Ending::singular || outcome.ending == Ending::terminal;
        trip.ending = ending_.empty() ? std::string(name_of(outcome.ending)) : ending_;
        trip.time = ending_.empty() ? outcome.time : time_;
        trip.contacts = contacts_;
        trip.speed = speed_;
        if (!trip.ended)
            trip.detail = outcome.detail;
        return trip;
    }

    /// Resets the observer for a new motion.
    void forget() {
        ending_.clear();
        time_ = speed_ = 0;
        contacts_ = 0;
    }

private:
    /// A level that the motion may only reach at a contact, as that of a stop: round-off decides whether its crossing
    /// is detected, so it is tested at contacts too.
    struct Level {
        explicit Level(const TripEnd& end) {
            if (end.quantity)
                expression = *end.quantity - end.level;
        }
        bool is_reached(std::span<const double> state) {
            constexpr double round_off = 64 * 0x1p-53;
            if (!expression || !system)
                return false;
            if (!function)
                function = system->function_of({&*expression, 1});
            const std::vector<double> inputs = concatenated(state, parameters);
            std::vector<double> errors;
            for (const double number : inputs)
                errors.push_back(round_off * std::abs(number));
            double bound = 0;
            std::vector<double> work(2 * function->workspace());
            function->error_bounds(inputs, errors, {&bound, 1}, work);
            return std::abs((*function)(inputs)[0]) <= bound;
        }
        std::optional<Expression> expression{}; ///< zero at the level
        std::optional<System> system{};
        std::optional<Function> function{}; ///< compiled expression, made at the first contact
        std::vector<double> parameters{};
    };
    bool is_over(double time) const { return !ending_.empty() && time >= time_; }
    void note(const char* ending, double time) {
        ending_ = ending;
        time_ = time;
    }

    Counts counts_;
    double speed_limit_;
    std::function<bool()> interrupted_;
    Level level_;
    std::string ending_;
    double time_ = 0, speed_ = 0;
    std::size_t contacts_ = 0;
};

/// Returns the simulation for an EndWatch: probe 0 is the level of the quantity, if given. With another probe, probe 0
/// exists always and never happens without a quantity.
inline Simulation simulation_until(const System& system, const TripEnd& end, const TripOptions& options,
                                   const std::optional<Probe>& further = std::nullopt) {
    SimulationOptions numbers = integration(options.tolerance);
    numbers.step_limit = options.step_limit;
    std::vector<Probe> probes;
    if (end.quantity || further) {
        Probe& level = probes.emplace_back();
        level.name = "end";
        level.expression = end.quantity ? *end.quantity - end.level : system.model().number(1);
    }
    if (further)
        probes.push_back(*further);
    return Simulation(system, std::move(probes), {}, numbers);
}

/// Simulates the motion from a state at time 0 until the watch stops it.
inline TripTime run_until(const Simulation& simulation, std::span<const double> parameters,
                          std::span<const double> state, std::size_t mode, double longest, EndWatch& watch) {
    watch.begin(simulation.system(), parameters);
    Trajectory trajectory(simulation, parameters, borrowed(watch));
    trajectory.start(state, mode, 0, longest);
    JetSet jets(simulation, LaneKind::single);
    run(trajectory, jets);
    return watch.trip(trajectory.outcome());
}

} // namespace graze
