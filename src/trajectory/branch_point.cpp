// Radicands that fall to zero: beyond a zero, Taylor series would continue on the other branch of a root or power.

#include "graze/trajectory/trajectory.hpp"

#include "base/special_numbers.hpp"
#include "graze/flow/mode_flow.hpp"
#include "trajectory/series.hpp"
#include "trajectory/tangents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// A radicand falls at most to this share in one step, so that the polynomials of the states determine it relative to
/// its own size, however close to zero it comes.
constexpr double least_share_left = 1e-2;
/// An arc that starts where a radicand is zero, such as a Hertz contact, has no series there. It is advanced along its
/// rates by these shares of the time scale of the motion, at first and at most; the last number is the allowed
/// difference of the two integration rules, relative to the state or to its change.
constexpr double first_leave = 1e-12, last_leave = 1e-9, leave_accuracy = 1e-15;
/// The same by the flow in which the motion is analytic there: the largest share, and the first one divided by it.
/// The first arc of a trajectory has a time scale of its own, which is that of the contact if this is shallow.
constexpr double longest_leave = 1e-5, shortest_leave = 1e-7, first_arc_leave = 0.1;
/// Factor by which the radicand must exceed its initial value, which is zero but for round-off.
constexpr double clear_of_zero = 100;
/// Where the motion is as close to a zero of a radicand as the resolution of time allows, it is extrapolated to this
/// share of the remaining radicand. Extrapolation is valid if the rates grow at most by `most_growth` and the radicand
/// falls at least by `least_fall`.
constexpr double left_share = 1e-9, most_growth = 2, least_fall = 0.75;
/// Relative errors of a rate from its series: one that is detected, and one at which the error begins.
constexpr double least_jump = 1e-6, certain_jump = 1e-12;

/// Returns the time after which a radicand (with positive power) falls to zero along the rates of a state, if it is of
/// the order of `radius`; negative if none does.
/// @param inputs state and parameters; restored afterwards
double time_to_zero(const Function& roots, std::span<double> inputs, std::span<const double> rates, double radius,
                    std::span<double> work) {
    std::vector<double> now(roots.outputs()), then(roots.outputs()), state(inputs.begin(), inputs.end());
    roots.evaluate(inputs, now, work);
    for (std::size_t i = 0; i < rates.size(); ++i)
        inputs[i] += 0.5 * radius * rates[i];
    roots.evaluate(inputs, then, work);
    std::copy(state.begin(), state.end(), inputs.begin());
    for (std::size_t r = 0; r < now.size(); r += 2)
        if (now[r + 1] > 0 && now[r + 1] != std::floor(now[r + 1]) && now[r] > 0 && then[r] < least_fall * now[r])
            return 0.5 * radius * now[r] / (now[r] - then[r]);
    return -1;
}

} // namespace

/// Returns a state whose rate differs from its series at s; the number of states if there is none.
/// @param share allowed difference relative to the size of the series
std::size_t Trajectory::jumping_rate(double s, double share) {
    for (std::size_t i = 0; i < states_; ++i)
        inputs_[i] = evaluate_state(i, s);
    values_.resize(states_);
    compiled_mode_->rates.evaluate(inputs_, values_, work_);
    for (std::size_t i = 0; i < states_; ++i) {
        const double foreseen = evaluate_derivative(series(i), s), difference = std::abs(values_[i] - foreseen);
        const bool jumps = difference > 0.5 * (std::abs(values_[i]) + std::abs(foreseen)) &&
                           s * difference > share * series_size(series(i), s) && !is_roundoff(i, difference);
        if (jumps || !std::isfinite(values_[i]))
            return i;
    }
    return states_;
}

/// Returns whether a rate differs from its series equally at the beginning of the step, by round-off: a rate may
/// consist of round-off entirely, such as that of an antisymmetric mode of a beam at rest.
bool Trajectory::is_roundoff(std::size_t state, double difference) {
    constexpr double most = 1e4;
    std::vector<double> rates(states_);
    for (std::size_t i = 0; i < states_; ++i)
        inputs_[i] = evaluate_state(i, 0);
    compiled_mode_->rates.evaluate(inputs_, rates, work_);
    return difference <= most * std::abs(rates[state] - evaluate_derivative(series(state), 0));
}

/// Returns whether any radicand at s is too small a share of its value at the start of the step.
bool Trajectory::root_vanishes(double s) {
    const Function& roots = compiled_mode_->roots;
    values_.resize(2 * roots.outputs());
    const auto at_start = std::span(values_).subspan(roots.outputs());
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    roots.evaluate(inputs_, at_start, work_);
    for (std::size_t i = 0; i < states_; ++i)
        inputs_[i] = evaluate_state(i, s);
    roots.evaluate(inputs_, values_, work_);
    for (std::size_t r = 0; r < roots.outputs(); r += 2)
        if (at_start[r] > 0 && !(values_[r] >= least_share_left * at_start[r]) &&
            at_start[r + 1] != std::floor(at_start[r + 1]))
            return true;
    return false;
}

/// Where a radicand has a double zero, series continue through it onto the other branch of the root; only the rates
/// beyond reveal this. (x' = -sqrt(x) has the solution (1 - t/2)^2 only until t = 2.) Shortens the step to end before
/// the zero, so that no event beyond it is seen. If there is no room for a step, returns the state whose rate jumps.
std::size_t Trajectory::limit_to_branch(double& step) {
    if (!compiled_mode_->has_roots || !(step > 0))
        return states_;
    const double whole = step;
    const std::size_t jumping = jumping_rate(whole, std::max(least_jump, 1000 * simulation_.options().tolerance));
    // High powers of a vanishing radicand are flat there and seem harmless far beyond the zero: hence the test at half
    // way.
    if (jumping == states_ && !root_vanishes(whole) && !root_vanishes(0.5 * whole))
        return states_;
    double low = 0, high = whole;
    for (double middle = 0.5 * high; high - low > 1e-3 * high && middle > low && middle < high;
         middle = 0.5 * (low + high))
        (jumping_rate(middle, certain_jump) == states_ && !root_vanishes(middle) ? low : high) = middle;
    if (jumping != states_)
        branch_ahead_ = jumping;
    if (high > 8 * epsilon * (time_ - start_time_ + high)) {
        step = low;
        return states_;
    }
    if (jumping != states_)
        step = low;
    return jumping;
}

void Trajectory::finish_at_branch(std::size_t state) {
    finish(Ending::undefined, time_,
           fmt::format("the rate of state '{}' jumps {}: the argument of a root or power reaches zero; end the mode "
                       "by an event before it does",
                       simulation_.model().states[state].name, where()));
}

/// Computes the state after a short time by the trapezoidal rule. Returns false if any radicand is not clear of zero
/// then, or the midpoint rule gives another result.
bool Trajectory::can_leave_branch_by(double time, std::span<double> after) {
    const Function& roots = compiled_mode_->roots;
    std::vector<double> start(states_), end(states_), middle(states_), before(roots.outputs()), then(roots.outputs());
    const auto rates_at = [&](double share, std::span<const double> rates, std::span<double> result) {
        for (std::size_t i = 0; i < states_; ++i)
            inputs_[i] = state_[i] + share * time * rates[i];
        compiled_mode_->rates.evaluate(inputs_, result, work_);
    };
    rates_at(0, start, start);
    roots.evaluate(inputs_, before, work_);
    std::vector<double> known = start;
    for (double& rate : known)
        rate = std::isfinite(rate) ? rate : 0; // a power of a radicand made negative by round-off
    rates_at(1, known, end);
    roots.evaluate(inputs_, then, work_);
    bool leaves = false;
    for (std::size_t r = 0; r < then.size(); r += 2) {
        if (!(before[r + 1] > 0) || before[r + 1] == std::floor(before[r + 1]))
            continue;
        if (then[r] > clear_of_zero * std::abs(before[r]))
            leaves = true;
        else if (!(before[r] > 0 && then[r] > 0.5 * before[r])) // the radicand is not at zero
            return false;
    }
    for (std::size_t i = 0; i < states_; ++i)
        start[i] = std::isfinite(start[i]) ? 0.5 * (start[i] + end[i]) : end[i];
    rates_at(0.5, start, middle);
    for (std::size_t i = 0; i < states_; ++i) {
        after[i] = state_[i] + time * start[i];
        const double size = std::max(std::abs(state_[i]), time * std::max(std::abs(start[i]), std::abs(end[i])));
        if (!std::isfinite(after[i]) || !(time * std::abs(middle[i] - start[i]) <= leave_accuracy * size))
            return false;
    }
    return leaves;
}

/// Leaves the zero of a radicand that is the function of an event by the flow in which the motion is analytic there.
/// @return the time after which the function is clear of its round-off; 0 if that takes longer than `longest`
double Trajectory::leave_root(double longest) {
    const Function& roots = compiled_mode_->roots;
    std::vector<double> after(states_), then(roots.outputs()), errors(roots.outputs());
    if (!leaving_)
        leaving_ = std::make_unique<ModeFlow>(simulation_.system(), simulation_.options().tolerance, order_);
    leaving_->set_parameters(parameters_);
    for (double time = shortest_leave * longest; time <= longest; time *= 8) {
        after.assign(state_.begin(), state_.end());
        if (leaving_->run(mode_, after, time) != ModeFlow::Ending::done)
            return 0;
        std::copy(after.begin(), after.end(), inputs_.begin());
        std::fill(uncertain_.begin(), uncertain_.end(), 0.0);
        for (std::size_t i = 0; i < states_; ++i)
            uncertain_[i] = epsilon * std::abs(after[i]);
        roots.evaluate(inputs_, then, work_);
        roots.error_bounds(inputs_, uncertain_, errors, work_);
        bool clear = true;
        for (std::size_t r = 0; r < then.size(); r += 2)
            clear = clear && (then[r] > clear_of_zero * errors[r] || then[r + 1] == std::floor(then[r + 1]));
        if (!clear)
            continue;
        if (tangents_)
            tangents_->leave_root(mode_, state_, time);
        state_.assign(after.begin(), after.end());
        return time;
    }
    return 0;
}

/// Called at the start of an arc whose series do not exist or allow no step. @return whether the motion has left the
/// zero
bool Trajectory::leave_branch() {
    if (!compiled_mode_->has_roots || !arc_start_)
        return false;
    std::vector<double> after(states_);
    double scale = largest_step_;
    if (!(scale > 0)) { // the shortest time in which a state changes by its own size
        std::copy(state_.begin(), state_.end(), inputs_.begin());
        compiled_mode_->rates.evaluate(inputs_, after, work_);
        for (std::size_t i = 0; i < states_; ++i) {
            const double size = periods_[i] > 0 ? periods_[i] : std::abs(state_[i]), time = size / std::abs(after[i]);
            if (time > 0 && std::isfinite(time) && (scale == 0 || time < scale))
                scale = time;
        }
        scale = scale > 0 ? scale : 1;
    }
    const double remaining = (end_time_ - time_) - time_low_;
    if (compiled_mode_->ends_at_root)
        if (const double left =
                leave_root(std::min((largest_step_ > 0 ? longest_leave : first_arc_leave) * scale, 0.5 * remaining));
            left > 0) {
            add_time(left);
            wrap_cyclic_states(false);
            return true;
        }
    double time = -1;
    for (double share = first_leave; time < 0 && share <= last_leave && share * scale < remaining; share *= 8)
        time = can_leave_branch_by(share * scale, after) ? share * scale : -1;
    if (time < 0 && remaining <= last_leave * scale) { // the trajectory ends before the motion has left
        std::copy(state_.begin(), state_.end(), inputs_.begin());
        compiled_mode_->rates.evaluate(inputs_, after, work_);
        bool finite = true;
        for (std::size_t i = 0; i < states_; ++i) {
            after[i] = state_[i] + remaining * after[i];
            finite = finite && std::isfinite(after[i]);
        }
        time = finite ? remaining : -1;
    }
    if (time < 0)
        return false;
    if (tangents_)
        tangents_->leave_root(mode_, state_, time);
    state_.assign(after.begin(), after.end());
    add_time(time);
    wrap_cyclic_states(false);
    return true;
}

/// Called when steps have become too short for the resolution of time. At a pole the solution ends; where a radicand
/// falls to zero the rates are finite, and only undefined beyond.
void Trajectory::finish_singular() {
    // If a series has only a few terms, its last ones are round-off, and their ratio is not a radius of convergence.
    const double radius = std::min(step_size_.radius(series_.first(states_)), 16 * proposed_);
    std::vector<double> rates(states_), closer(states_), beyond(states_);
    std::copy(state_.begin(), state_.end(), inputs_.begin());
    compiled_mode_->rates.evaluate(inputs_, rates, work_);
    const double left =
        compiled_mode_->has_roots ? time_to_zero(compiled_mode_->roots, inputs_, rates, radius, work_) : -1;
    if (left > 0) {
        const auto rates_after = [&](double time, std::span<double> result) {
            for (std::size_t i = 0; i < states_; ++i)
                inputs_[i] = state_[i] + time * rates[i];
            compiled_mode_->rates.evaluate(inputs_, result, work_);
        };
        rates_after((1 - left_share) * left, closer);
        rates_after(2 * left, beyond);
        std::size_t lost = states_;
        bool finite = true;
        for (std::size_t i = 0; i < states_; ++i) {
            finite = finite && std::abs(closer[i]) <= most_growth * std::abs(rates[i]);
            lost = lost == states_ && !std::isfinite(beyond[i]) ? i : lost;
        }
        if (finite && lost < states_) {
            finish(Ending::undefined, std::min(time_ + radius, end_time_),
                   fmt::format("the argument of a root or power in the rate of state '{}' reaches zero {}, and no "
                               "rate is known beyond: make that zero an event, and what follows a mode",
                               simulation_.model().states[lost].name, where()));
            return;
        }
    }
    if (ends_at_two_fold())
        return finish_at_two_fold(std::min(time_ + radius, end_time_));
    if (finish_at_paradox(std::min(time_ + radius, end_time_)))
        return;
    finish(Ending::singular, std::min(time_ + radius, end_time_));
}

} // namespace graze
