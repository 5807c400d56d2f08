#include "design/reset_steps.hpp"

#include "flow/guard.hpp"

#include "base/concatenated.hpp"
#include "graze/base/input_error.hpp"
#include "graze/sweep/point_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t fewest_steps = 24, further_steps = 7;
/// For a motion that is not at rest the loss depends on the sequence of steps: number of sequences tried.
constexpr std::size_t most_ways = 5;
constexpr double narrow = 1e-6; ///< size of the last step, relative to the whole way
constexpr double alike = 1e-6;  ///< relative difference of states of the same motion; Newton's method closes far better

bool is_settled(const PointResult& motion) {
    return motion.label == Label::periodic || motion.label == Label::equilibrium;
}

bool goes_on(const PointResult& motion) {
    return is_settled(motion) || motion.label == Label::chaotic || motion.label == Label::quasi_periodic ||
           motion.label == Label::unsettled;
}

std::string ending(const PointResult& motion) {
    return fmt::format("{}{}{}", name_of(motion.label), motion.outcome.detail.empty() ? "" : ", ",
                       motion.outcome.detail);
}

/// Tracks two motions over values of the control parameter: the one that has tripped, and the one that has not.
class SteppedReset {
public:
    SteppedReset(const TripPoint& trip, const Orbit& orbit, const System& system, const AttractorOptions& settle,
                 const ResetOptions& options)
        : trip_(trip), orbit_(orbit), system_(system), model_(system.model()), options_(options),
          factory_(attractor_searches(system, settle, {at_section(settle.section)}, model_.state_symbols(), {})),
          search_(factory_->make()), jets_(factory_->simulation(), LaneKind::single) {}

    Reset find() {
        PointResult begin;
        begin.state = model_.initial_state();
        begin.mode = model_.initial_mode;
        const double start = trip_.value() + options_.overshoot;
        begin = settle(start, begin);
        if (interrupted_ || !goes_on(begin))
            return unknown("the tripped motion does not go on: it is " + ending(begin));
        reset_.motion = name_of(begin.label);
        const std::size_t ways = begin.label == Label::equilibrium ? 1 : most_ways;
        for (std::size_t way = 0; way < ways; ++way) {
            tripped_ = begin;
            resting_.state = orbit_.starts.front();
            resting_.mode = orbit_.signature.front().mode;
            if (!go_back(start, fewest_steps + way * further_steps))
                return reset_;
        }
        reset_.value = remains_at_;
        reset_.lost_at = lost_at_;
        reset_.how =
            found_.label == Label::equilibrium ? "return to rest" : "return to the motion that had not tripped";
        return reset_;
    }

private:
    enum class Step { remains, lost, unknown };

    static Sampling at_section(const std::string& section) {
        Sampling sampling;
        sampling.name = section;
        sampling.section = section;
        return sampling;
    }

    Reset unknown(const std::string& reason) {
        reset_.reason = interrupted_ ? "interrupted" : reason;
        return reset_;
    }

    /// Goes back in a number of steps that are small at first, where the untripped motion is near the known orbit.
    /// @return false if the loss could not be found
    bool go_back(double start, std::size_t steps) {
        const double from = trip_.value(), way = options_.least - from;
        double there = start;
        for (std::size_t i = 1; i <= steps; ++i) {
            const double share = static_cast<double>(i * i) / static_cast<double>(steps * steps);
            const double value = from + way * share;
            const Step step = try_step(value);
            if (step == Step::unknown)
                return false;
            if (step == Step::lost && i == 1)
                return fail(fmt::format("at {:.9g} already, next to the trip value, the tripped motion and the other "
                                        "one settle on the same",
                                        value));
            if (step == Step::lost)
                return halve(there, value, std::abs(way));
            there = value;
        }
        return fail(fmt::format("the tripped motion is still there at {:.9g}", options_.least));
    }

    bool halve(double there, double lost, double way) {
        while (std::abs(there - lost) > narrow * way) {
            const double middle = 0.5 * (there + lost);
            const Step step = try_step(middle);
            if (step == Step::unknown) {
                reset_.reason += fmt::format("; it is there at {:.9g} and lost at {:.9g}", there, lost);
                return false;
            }
            (step == Step::lost ? lost : there) = middle;
        }
        // Combine all sequences: the nearest value at which the motion remained, the farthest at which it was lost.
        const double down = options_.least < trip_.value() ? 1 : -1;
        remains_at_ = remains_at_ ? down * std::max(down * *remains_at_, down * there) : there;
        lost_at_ = lost_at_ ? down * std::min(down * *lost_at_, down * lost) : lost;
        return true;
    }

    bool fail(const std::string& reason) {
        unknown(reason);
        if (remains_at_ && !interrupted_)
            reset_.reason +=
                fmt::format("; on another way down it was lost between {:.9g} and {:.9g}", *lost_at_, *remains_at_);
        return false;
    }

    /// Settles a motion at another value of the control parameter, from its present state.
    PointResult settle(double value, PointResult motion) {
        constexpr std::size_t most = 4; // barriers passed in succession
        std::vector<double> parameters = orbit_.parameters;
        parameters[trip_.control.place()] = value;
        for (std::size_t met = 0;; ++met) {
            PointResult result = search(motion, parameters);
            const bool passed = result.outcome.ending == Ending::inadmissible && result.outcome.time == 0;
            if (interrupted_ || !passed || met == most || !meet_passed_barrier(motion, parameters))
                return result;
        }
    }

    PointResult search(const PointResult& motion, const std::vector<double>& parameters) {
        search_->begin(parameters, motion.state, motion.mode);
        do {
            interrupted_ = interrupted_ || (options_.interrupted && options_.interrupted());
            if (interrupted_)
                return {};
            run(search_->trajectory(), jets_);
        } while (search_->proceed());
        PointResult result = std::move(search_->result());
        for (std::size_t i = 0; i < result.state.size(); ++i)
            sizes_[i] = std::max(sizes_[i], std::abs(result.state[i]));
        return result;
    }

    /// A change of the control parameter alone may bring a motion at rest to a barrier, such as that of the force with
    /// which a stop holds it: then its transition is taken before anything moves. @return false if no motion follows
    bool meet_passed_barrier(PointResult& motion, const std::vector<double>& parameters) const {
        std::vector<double> work(system_.workspace()), conditions, inputs = concatenated(motion.state, parameters);
        const System::CompiledMode& mode = system_.mode(motion.mode);
        std::vector<double> values(mode.watched.size());
        mode.events.evaluate(inputs, values, work);
        for (std::size_t w = 0; w < values.size(); ++w) {
            if (model_.events[mode.watched[w]].kind != EventKind::barrier || !(values[w] < 0))
                continue;
            const auto chosen = chosen_transition(system_, mode.transitions[w], {}, inputs, conditions, work);
            if (!chosen)
                return false;
            const std::size_t transition = *chosen;
            system_.jump(system_.transition(transition).jump).map.evaluate(inputs, motion.state, work);
            std::ranges::copy(motion.state, inputs.begin());
            const System::CompiledAlternative* next = chosen_alternative(system_, transition, inputs, conditions, work);
            if (!next || !next->mode)
                return false;
            motion.mode = *next->mode;
            return true;
        }
        return false;
    }

    /// Takes both motions to a value, unless the tripped one is lost there.
    Step try_step(double value) {
        PointResult resting = settle(value, resting_), tripped = settle(value, tripped_);
        if (interrupted_ || !goes_on(tripped)) {
            fail(fmt::format("the tripped motion does not go on at {:.9g}: it is {}", value, ending(tripped)));
            return Step::unknown;
        }
        if (!is_settled(resting)) {
            fail(fmt::format("the motion that has not tripped does not settle at {:.9g}: it is {}", value,
                             ending(resting)));
            return Step::unknown;
        }
        if (are_same(tripped, resting)) {
            found_ = resting;
            return Step::lost;
        }
        resting_ = std::move(resting);
        tripped_ = std::move(tripped);
        return Step::remains;
    }

    /// Whether two motions are equal; orbits with several returns may be at any of them.
    bool are_same(const PointResult& a, const PointResult& b) const {
        if (!is_settled(a) || !is_settled(b) || a.mode != b.mode || a.period != b.period)
            return false;
        if (is_same_state(a.state, b.state))
            return true;
        const std::size_t width = b.samples.width;
        for (std::size_t k = 0; width == b.state.size() && k < b.samples.size(); ++k)
            if (is_same_state(a.state, {b.samples.values.data() + k * width, width}))
                return true;
        return false;
    }
    /// Compares states except cyclic ones, which are equal at a section, and drifting ones, which never are.
    bool is_same_state(std::span<const double> a, std::span<const double> b) const {
        for (std::size_t i = 0; i < a.size(); ++i)
            if (!model_.states[i].period && !model_.states[i].drifting && !(std::abs(a[i] - b[i]) <= alike * sizes_[i]))
                return false;
        return true;
    }

    const TripPoint& trip_;
    const Orbit& orbit_;
    const System& system_;
    const Model& model_;
    const ResetOptions& options_;
    std::unique_ptr<SearchFactory> factory_;
    std::unique_ptr<PointSearch> search_;
    JetSet jets_;
    PointResult tripped_, resting_, found_;
    std::vector<double> sizes_ = sizes_of_orbit();
    std::optional<double> remains_at_, lost_at_;
    bool interrupted_ = false;
    Reset reset_;

    /// Magnitudes of the states along the untripped orbit: at a section a state may be zero.
    std::vector<double> sizes_of_orbit() const {
        constexpr std::size_t parts = 16;
        const Simulation simulation(trip_.system, {}, {}, {});
        JetSet jets(simulation, LaneKind::single);
        std::vector<double> sizes(model_.states.size()), state = orbit_.starts.front();
        std::size_t mode = orbit_.signature.front().mode;
        for (std::size_t part = 0;; ++part) {
            for (std::size_t i = 0; i < sizes.size(); ++i)
                sizes[i] = std::max(sizes[i], std::abs(state[i]));
            if (part == parts)
                return sizes;
            Trajectory trajectory(simulation, orbit_.parameters);
            trajectory.start(state, mode, 0, orbit_.period() / static_cast<double>(parts));
            run(trajectory, jets);
            if (trajectory.outcome().ending != Ending::end_time)
                return sizes;
            state.assign(trajectory.state().begin(), trajectory.state().end());
            mode = trajectory.mode();
        }
    }
};

} // namespace

Reset reset_by_steps(const TripPoint& trip, const Orbit& orbit, const System& system, const AttractorOptions& settle,
                     const ResetOptions& options) {
    try {
        return SteppedReset(trip, orbit, system, settle, options).find();
    } catch (const InputError& error) { // a state that is inadmissible at another value
        Reset reset;
        reset.reason = error.problem();
        return reset;
    }
}

} // namespace graze
