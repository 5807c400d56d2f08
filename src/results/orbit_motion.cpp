#include "graze/results/orbit_motion.hpp"

#include "graze/orbit/signature.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/trajectory/recorder.hpp"
#include "graze/trajectory/trajectory.hpp"
#include "orbit/segment_arcs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace graze {

namespace {

constexpr double orbit_tolerance = 1e-13; ///< the tolerance at which orbits are computed
/// Limit for all segments together. Computed orbits take some hundreds of steps, but a file may have any duration.
constexpr std::size_t most_steps_of_orbit = 100'000;

/// Takes samples until no steps are left.
class BoundedSampler : public Sampler {
public:
    BoundedSampler(std::size_t& left, double spacing, std::size_t count, std::vector<double> periods, Receiver receiver)
        : Sampler(0, spacing, count, std::move(periods), std::move(receiver)), left_(&left) {}
    void step(const Step& step) override {
        Sampler::step(step);
        *left_ -= *left_ > 0 ? 1 : 0;
    }
    bool stop() override { return *left_ == 0; }

private:
    std::size_t* left_;
};

/// The model without events and transitions, so that motion in a mode is smooth.
Model without_events(Model model, bool backwards) {
    for (Mode& mode : model.modes) {
        mode.watched.clear();
        for (Expression& rate : mode.rates)
            rate = backwards ? -rate : rate;
    }
    model.transitions.clear();
    return model;
}

/// Computes the motion along segments, forwards or backwards in time.
class SmoothMotion {
public:
    /// @param left number of steps that may still be taken
    SmoothMotion(const Model& model, bool backwards, std::size_t& left)
        : left_(&left), parameters_(model.parameter_values()), periods_(model.periods()),
          simulation_(System(without_events(model, backwards)), {}, {}, options()),
          jets_(simulation_, LaneKind::single) {}

    /// @param duration positive; @param receive called with the time since the start of the segment, and the state
    /// @return why the motion stopped before this duration; empty if it did not
    template <class Receive>
    std::string follow(const std::vector<double>& start, std::size_t mode, double duration, std::size_t intervals,
                       Receive receive) {
        if (!std::isfinite(duration))
            return "its duration is no number";
        BoundedSampler sampler(*left_, duration / static_cast<double>(intervals), intervals, periods_,
                               [&](double time, std::size_t, std::span<const double> state) { receive(time, state); });
        Trajectory trajectory(simulation_, parameters_, borrowed(sampler));
        trajectory.start(start, mode, 0, duration);
        graze::run(trajectory, jets_);
        const Outcome& outcome = trajectory.outcome();
        if (*left_ == 0)
            return fmt::format("the orbit takes more than {} steps", most_steps_of_orbit);
        if (outcome.ending != Ending::end_time)
            return outcome.detail.empty() ? std::string(name_of(outcome.ending)) : outcome.detail;
        receive(duration, trajectory.state());
        return {};
    }

private:
    static SimulationOptions options() {
        SimulationOptions options;
        options.tolerance = orbit_tolerance;
        return options;
    }
    std::size_t* left_;
    std::vector<double> parameters_, periods_;
    Simulation simulation_;
    JetSet jets_;
};

} // namespace

Model model_at(const Model& model, const Orbit& orbit) {
    Model result = model;
    const std::vector<std::string> names = model.independent_parameters();
    for (std::size_t i = 0; i < names.size(); ++i)
        result.set_parameter(names[i], orbit.parameters[i]);
    return result;
}

std::vector<SegmentMotion> orbit_motion(const Model& model, const Orbit& orbit, std::size_t samples) {
    const Model there = model_at(model, orbit);
    std::size_t left = most_steps_of_orbit;
    SmoothMotion forwards(there, false, left);
    SimulationOptions options;
    options.tolerance = orbit_tolerance;
    SegmentArcsFinder arcs_of(Simulation(System(there), {}, {}, options));
    double whole = 0, time = 0;
    for (const double duration : orbit.durations)
        whole += std::abs(duration);
    std::vector<SegmentMotion> motion;
    for (std::size_t s = 0; s < orbit.segments(); ++s) {
        const double duration = orbit.durations[s];
        SegmentMotion& segment = motion.emplace_back();
        segment.mode = orbit.signature[s].mode;
        segment.end = end_name(model, orbit.signature[s]);
        const double share = whole > 0 && std::isfinite(whole) ? std::abs(duration) / whole : 0;
        const auto intervals =
            static_cast<std::size_t>(std::max(1.0, std::round(share * static_cast<double>(samples))));
        const auto receive = [&](double since, std::span<const double> state) {
            segment.times.push_back(time + std::copysign(since, duration));
            segment.states.emplace_back(state.begin(), state.end());
        };
        if (orbit.signature[s].end == SegmentEnd::rest) {
            receive(0, orbit.starts[s]);
        } else if (duration == 0) {
            receive(0, orbit.starts[s]);
            receive(0, orbit.starts[s]);
        } else if (duration > 0 && orbit.signature[s].end == SegmentEnd::chatter) {
            const SegmentArcs arcs = arcs_of(orbit, s);
            segment.problem = arcs.problem;
            double flown = 0;
            for (std::size_t i = 0; i + 1 < arcs.starts.size() && segment.problem.empty(); ++i) {
                const auto parts = static_cast<std::size_t>(
                    std::max(1.0, std::round(arcs.durations[i] / duration * static_cast<double>(intervals))));
                segment.problem = forwards.follow(
                    arcs.starts[i], segment.mode, arcs.durations[i], parts,
                    [&](double since, std::span<const double> state) { receive(flown + since, state); });
                flown += arcs.durations[i];
            }
            if (segment.problem.empty()) {
                receive(flown, arcs.starts.back());
                receive(duration, arcs.end.empty() ? arcs.starts.back() : arcs.end);
            }
        } else if (duration > 0) {
            segment.problem = forwards.follow(orbit.starts[s], segment.mode, duration, intervals, receive);
        } else {
            segment.problem =
                SmoothMotion(there, true, left).follow(orbit.starts[s], segment.mode, -duration, intervals, receive);
        }
        time += duration;
    }
    return motion;
}

} // namespace graze
