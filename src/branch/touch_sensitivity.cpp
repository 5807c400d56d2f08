#include "branch/touch_sensitivity.hpp"

#include "flow/guard.hpp"
#include "graze/orbit/solve.hpp"
#include "orbit/orbit_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace graze {

namespace {

/// Times from the contact to the touch that it replaces, as shares of a round; speeds are in proportion.
constexpr std::array<double, 5> earlier{4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4};

/// One pass along an arc near its touch.
class Pass {
public:
    Pass(const Simulation& simulation, const Orbit& orbit, std::size_t mode, std::size_t event)
        : simulation_(simulation), system_(simulation.system()), orbit_(orbit), mode_(mode), event_(event),
          flow_(flow_of(simulation)) {
        flow_.set_parameters(orbit.parameters);
    }

    /// The least value of the next round after an impact a short time before the touch, by the speed of that impact.
    std::optional<double> after_impact(const std::vector<double>& start, double time, double early) {
        std::vector<double> state = start;
        if (flow_.run(mode_, state, time - early) != ModeFlow::Ending::done || !move_to_contact(state))
            return std::nullopt;
        const double speed = -rate(state);
        const Transition* transition = system_.model().find_transition(mode_, event_);
        if (!(speed > 0) || !transition)
            return std::nullopt;
        const auto which = static_cast<std::size_t>(transition - system_.model().transitions.data());
        std::vector<double> work(system_.workspace());
        if (!system_.jump(transition->jump).identity)
            system_.jump(transition->jump).map.evaluate(with_parameters(state), state, work);
        const auto least = least_of_next_round(state, which, early);
        return least ? std::optional(*least / speed) : std::nullopt;
    }

private:
    std::vector<double> with_parameters(const std::vector<double>& state) const {
        std::vector<double> inputs = state;
        inputs.insert(inputs.end(), orbit_.parameters.begin(), orbit_.parameters.end());
        return inputs;
    }
    double value(const std::vector<double>& state) const { return system_.event(event_)(with_parameters(state))[0]; }
    double rate(const std::vector<double>& state) const {
        const std::vector<double> inputs = with_parameters(state), function = system_.event(event_)(inputs),
                                  rates = system_.mode(mode_).rates(inputs);
        double sum = 0;
        for (std::size_t i = 0; i < rates.size(); ++i)
            sum += function[1 + i] * rates[i];
        return sum;
    }

    /// Across the surface, by what is of second order in the time that is left until the touch.
    bool move_to_contact(std::vector<double>& state) const {
        constexpr int iterations = 4;
        for (int iteration = 0; iteration < iterations; ++iteration) {
            const std::vector<double> function = system_.event(event_)(with_parameters(state));
            double square = 0;
            for (std::size_t i = 0; i < state.size(); ++i)
                square += function[1 + i] * function[1 + i];
            if (!(square > 0))
                return false;
            for (std::size_t i = 0; i < state.size(); ++i)
                state[i] -= function[0] / square * function[1 + i];
        }
        return true;
    }

    std::optional<std::size_t> mode_after(std::size_t transition, const std::vector<double>& state) const {
        std::vector<double> conditions, work(system_.workspace());
        const auto* chosen = chosen_alternative(system_, transition, with_parameters(state), conditions, work);
        return chosen ? chosen->mode : std::nullopt;
    }

    /// Cuts a motion off before the contact that takes the place of the next touch: it has one more than the orbit.
    void leave_out_return(FollowedMotion& motion, std::size_t transition) const {
        const auto is_contact = [&](const Segment& one) {
            return one.end == SegmentEnd::event && one.index == transition;
        };
        auto own = std::count_if(orbit_.signature.begin(), orbit_.signature.end(), is_contact);
        for (std::size_t k = 0; k < motion.segments.size(); ++k)
            if (is_contact(motion.segments[k]) && own-- == 0) {
                motion.segments.resize(k);
                motion.durations.resize(k);
                motion.starts.resize(k + 1);
                motion.problem.clear();
                return;
            }
    }

    std::optional<double> least_of_next_round(const std::vector<double>& state, std::size_t transition, double early) {
        const auto mode = mode_after(transition, state);
        // So long before the next touch that whatever the impact changes does not bring the next contact before.
        constexpr double before_next = 4;
        const double time = orbit_.round() - before_next * early;
        if (!mode || !(time > 0))
            return std::nullopt;
        FollowedMotion motion = follow_motion(simulation_, orbit_.parameters, state, *mode, time);
        leave_out_return(motion, transition);
        if (!motion.problem.empty())
            return std::nullopt;
        std::optional<std::size_t> last = mode;
        if (!motion.segments.empty()) {
            const Segment& segment = motion.segments.back();
            last = segment.end == SegmentEnd::event ? mode_after(segment.index, motion.starts.back()) : segment.mode;
        }
        if (last != mode_)
            return std::nullopt;
        std::vector<double> end = motion.starts.back();
        const double left = time - std::accumulate(motion.durations.begin(), motion.durations.end(), 0.0);
        if (flow_.run(mode_, end, left) != ModeFlow::Ending::done || !go_to_least(end, before_next * early))
            return std::nullopt;
        return value(end);
    }

    /// Along the arc to where the function is least, by the secant method on its rate; on through the surface.
    bool go_to_least(std::vector<double>& state, double away) {
        constexpr int iterations = 30;
        constexpr double enough = 1e-9; // of the first step: the value is flat there
        double step = away, before = rate(state);
        for (int iteration = 0; iteration < iterations; ++iteration) {
            if (flow_.run(mode_, state, step) != ModeFlow::Ending::done)
                return false;
            const double now = rate(state);
            if (now == before)
                return false;
            step *= -now / (now - before);
            before = now;
            if (!(std::abs(step) < 8 * away))
                return false;
            if (std::abs(step) < enough * away)
                return true;
        }
        return false;
    }

    const Simulation& simulation_;
    const System& system_;
    const Orbit& orbit_;
    std::size_t mode_, event_;
    ModeFlow flow_;
};

} // namespace

std::optional<double> touch_sensitivity(const Simulation& simulation, const Orbit& orbit, std::size_t segment,
                                        std::size_t event, double time) {
    if (orbit.symmetry)
        return std::nullopt;
    Pass pass(simulation, orbit, orbit.signature[segment].mode, event);
    // Neville's scheme, at an impact without speed.
    std::array<double, earlier.size()> values{};
    for (std::size_t i = 0; i < earlier.size(); ++i) {
        const auto one = pass.after_impact(orbit.starts[segment], time, earlier[i] * orbit.round());
        if (!one)
            return std::nullopt;
        values[i] = *one;
    }
    for (std::size_t level = 1; level < values.size(); ++level)
        for (std::size_t i = values.size() - 1; i >= level; --i)
            values[i] += (values[i] - values[i - 1]) / (earlier[i - level] / earlier[i] - 1);
    return std::isfinite(values.back()) ? std::optional(values.back()) : std::nullopt;
}

} // namespace graze
