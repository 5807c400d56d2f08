// Roots and powers of what falls to zero, behind which series go on along the other branch.

#include "graze/trajectory/trajectory.hpp"

#include "trajectory/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

namespace {

/// What stands under a root falls by no more than this in one step, so that the polynomials of the states tell it
/// relative to its own size, however close to zero it comes.
constexpr double least_share = 1e-2;
/// Shares of the size of a series by which its rate is off for certain: where that is found, and where it begins.
constexpr double least_jump = 1e-6, certain_jump = 1e-12;

} // namespace

/// A state whose rate the series do not follow at s; the number of states if there is none.
/// @param share of the size of the series that their rates may be off by
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

/// Whether a rate differs from its series where the step begins as well, by nothing but round-off: of that a rate may
/// consist altogether, as that of an antisymmetric mode of a beam at rest.
bool Trajectory::is_roundoff(std::size_t state, double difference) {
    constexpr double most = 1e4;
    std::vector<double> rates(states_);
    for (std::size_t i = 0; i < states_; ++i)
        inputs_[i] = evaluate_state(i, 0);
    compiled_mode_->rates.evaluate(inputs_, rates, work_);
    return difference <= most * std::abs(rates[state] - evaluate_derivative(series(state), 0));
}

/// Whether something under a root is no longer a fair share at s of what it is at the start of the step.
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
        if (at_start[r] > 0 && !(values_[r] >= least_share * at_start[r]) &&
            at_start[r + 1] != std::floor(at_start[r + 1]))
            return true;
    return false;
}

/// Where what is under a root has a double zero, series lead through it onto the other branch of the root, with no sign
/// of it but that the rates found behind are others. (x' = -sqrt(x) has the solution (1 - t/2)^2 only until t = 2.)
/// Ends the step on the way there, before anything of what lies behind is seen. Where no way is left, returns the state
/// whose rate jumps.
std::size_t Trajectory::limit_to_branch(double& step) {
    if (!compiled_mode_->has_roots || !(step > 0))
        return states_;
    const double whole = step;
    const std::size_t jumping = jumping_rate(whole, std::max(least_jump, 1000 * simulation_.options().tolerance));
    // High powers of what vanishes are flat there, and look harmless a good way behind: hence the look half way, too.
    if (jumping == states_ && !root_vanishes(whole) && !root_vanishes(0.5 * whole))
        return states_;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
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
    finish(
        Ending::undefined, time_,
        fmt::format("the rate of state '{}' jumps {}: what stands under a root or a power reaches zero; end the mode "
                    "by an event before it does",
                    simulation_.model().states[state].name, where()));
}

} // namespace graze
