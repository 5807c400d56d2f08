#include "flow/uniformised_flow.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace graze {

namespace {

/// More passages through zeros of a radicand within one run mean that the motion rattles there.
constexpr int most_phases = 1000;
/// A motion that reaches the zero within this share of the run starts there.
constexpr double at_zero_share = 1e-9;
/// Where exponents have no common fraction, powers are taken to be zero up to where the motion comes within this share
/// of a run; exponents must be at least 1 for the effect to be negligible.
constexpr double negligible_share = 1e-11;
/// Times differ by round-off if they differ by no more than this share.
constexpr double same_time = 64 * epsilon;

/// Initial values with respect to which derivatives are computed: those of the states and of the root.
std::vector<std::size_t> states_and_root(std::size_t states) {
    std::vector<std::size_t> all(states + 1);
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
}

} // namespace

UniformisedFlow::UniformisedFlow(const System& system, double tolerance, int order,
                                 const std::vector<ParameterId>& free, const std::vector<std::size_t>& starts)
    : system_(&system.uniformised()), own_(system), states_(system.states()), directions_(starts.size() + free.size()),
      starts_count_(starts.size()), free_(free), starts_(starts),
      flow_(system_->modes(), tolerance, order, free,
            directions_ > 0 ? states_and_root(states_) : std::vector<std::size_t>{}),
      finder_(order != 0 ? order : order_for_tolerance(tolerance)), state_(states_ + 2), matrix_(states_ * directions_),
      seeds_((states_ + 2) * directions_), by_seeds_((states_ + 2) * (states_ + 1 + free.size())), field_(states_),
      inputs_(states_ + 2 + system.parameters()), gradient_(1 + states_ + system.parameters()),
      work_(std::max(system.workspace(), system_->modes().workspace())), slopes_(directions_) {}

void UniformisedFlow::set_parameters(std::span<const double> parameters) {
    flow_.set_parameters(parameters);
    inputs_.resize(states_ + 2);
    inputs_.insert(inputs_.end(), parameters.begin(), parameters.end());
}

ModeFlow::Ending UniformisedFlow::run(std::size_t mode, std::span<double> state, double duration,
                                      std::span<double> derivatives) {
    derived_ = !derivatives.empty();
    ModeFlow::Ending ending = ModeFlow::Ending::undefined;
    for (const UniformisedRoot& root : system_->roots(mode)) {
        std::copy(state.begin(), state.end(), state_.begin());
        std::fill(matrix_.begin(), matrix_.end(), 0.0);
        for (std::size_t d = 0; d < starts_count_ && derived_; ++d)
            matrix_[starts_[d] * directions_ + d] = 1;
        ending = follow(root, duration);
        if (ending == ModeFlow::Ending::done)
            break;
    }
    const auto finite = [](double x) { return std::isfinite(x); };
    if (ending == ModeFlow::Ending::done &&
        !(std::ranges::all_of(state_, finite) && std::ranges::all_of(matrix_, finite)))
        ending = ModeFlow::Ending::undefined;
    std::copy_n(state_.begin(), states_, state.begin());
    if (derived_)
        std::ranges::copy(matrix_, derivatives.begin());
    return ending;
}

/// Follows the motion from zero to zero of one radicand.
ModeFlow::Ending UniformisedFlow::follow(const UniformisedRoot& root, double duration) {
    time_ = 0;
    reached_zero_ = reached_end_ = false;
    const std::vector<double> exponents = root.exponents(std::span<const double>(inputs_).subspan(states_ + 2));
    if (std::ranges::any_of(exponents,
                            [&](double exponent) { return !(exponent > 0 && (root.degree > 0 || exponent >= 1)); }))
        return ModeFlow::Ending::undefined;
    margin_ = 0;
    if (root.degree == 0) {
        const Place start = place(root);
        margin_ = negligible_share * std::max(std::abs(start.value), std::abs(start.rate * duration));
    }
    for (int phase = 0; phase < most_phases; ++phase) {
        const double left = duration - time_;
        // Near a zero the root knows more digits than the states do: a phase that has found its end is not begun again.
        if (reached_end_ || std::abs(left) <= same_time * std::abs(duration)) {
            find_field(root, reached_end_ ? state_[states_] : 0);
            for (std::size_t i = 0; i < states_; ++i)
                state_[i] += left * field_[i];
            return ModeFlow::Ending::done;
        }
        const Place here = place(root);
        if (!std::isfinite(here.value) || !std::isfinite(here.rate))
            return ModeFlow::Ending::undefined;
        const double towards = here.rate * left;
        const bool at_zero =
            reached_zero_ || (root.degree > 0 && std::abs(here.value) <= at_zero_share * std::abs(towards));
        const bool inside = at_zero ? towards > 0 : here.value > 0;
        const auto ending = inside ? pass_inside(root, here, left, at_zero)
                                   : pass_in_time(root.outside, root.output, 1, left, at_zero && towards < 0);
        if (root.degree > 0)
            end_touch();
        if (ending != ModeFlow::Ending::done)
            return ending;
    }
    return ModeFlow::Ending::too_long;
}

UniformisedFlow::Place UniformisedFlow::place(const UniformisedRoot& root) {
    find_field(root, 0);
    std::vector<double> inputs(state_.begin(), state_.begin() + static_cast<std::ptrdiff_t>(states_));
    inputs.insert(inputs.end(), inputs_.begin() + static_cast<std::ptrdiff_t>(states_) + 2, inputs_.end());
    root.radicand.evaluate(inputs, gradient_, work_);
    Place here{gradient_[0] - margin_, 0, std::span<const double>(gradient_).subspan(1)};
    for (std::size_t i = 0; i < states_; ++i)
        if (here.gradient[i] != 0)
            here.rate += here.gradient[i] * field_[i];
    return here;
}

/// Evaluates the rates of the states where the root of the radicand has a given value.
void UniformisedFlow::find_field(const UniformisedRoot& root, double of_root) {
    std::copy_n(state_.begin(), states_, inputs_.begin());
    inputs_[states_] = of_root;
    inputs_[states_ + 1] = 0;
    root.field.evaluate(inputs_, field_, work_);
}

/// Finds the change of the radicand in each direction.
void UniformisedFlow::find_slopes(const Place& here) {
    std::fill(slopes_.begin(), slopes_.end(), 0.0);
    for (std::size_t i = 0; i < states_; ++i)
        for (std::size_t d = 0; d < directions_ && here.gradient[i] != 0; ++d)
            slopes_[d] += here.gradient[i] * matrix_[i * directions_ + d];
    for (std::size_t f = 0; f < free_.size(); ++f)
        slopes_[starts_count_ + f] += here.gradient[states_ + free_[f].place()];
}

/// Begins a phase on the side g > 0. From the zero neighbouring motions start at the zero as well, at other times.
void UniformisedFlow::seed_inside(const UniformisedRoot& root, const Place& here, bool at_zero) {
    const double early = at_zero ? here.value / here.rate : 0;
    for (std::size_t i = 0; i < states_; ++i)
        state_[i] -= early * field_[i];
    state_[states_] = at_zero ? 0 : std::pow(here.value, 1.0 / root.degree);
    state_[states_ + 1] = -early;
    if (!derived_)
        return;
    find_slopes(here);
    const double share = at_zero ? 1 / here.rate : 1 / (root.degree * std::pow(state_[states_], root.degree - 1));
    for (std::size_t d = 0; d < directions_; ++d) {
        const double shift = slopes_[d] * share;
        for (std::size_t i = 0; i < states_; ++i)
            seeds_[i * directions_ + d] = matrix_[i * directions_ + d] - (at_zero ? field_[i] * shift : 0);
        seeds_[states_ * directions_ + d] = at_zero ? 0 : shift;
        seeds_[(states_ + 1) * directions_ + d] = at_zero ? -shift : 0;
    }
}

/// Makes a run of the uniformised system, and carries the derivatives to its end: seeds become a matrix at fixed time.
ModeFlow::Ending UniformisedFlow::advance(std::size_t mode, double longest, const ModeFlow::StepEnd& end) {
    const std::size_t columns = states_ + 1 + free_.size(), rows = states_ + 2;
    const std::vector<double> seeds = seeds_;
    const auto ending = derived_ ? flow_.run_until(mode, state_, longest, end, by_seeds_)
                                 : flow_.run_until(mode, state_, longest, end, {});
    if (ending != ModeFlow::Ending::done || !derived_)
        return ending;
    for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t d = 0; d < directions_; ++d) {
            double sum = i == states_ + 1 ? seeds[i * directions_ + d] : 0; // nothing depends on the time
            for (std::size_t j = 0; j <= states_; ++j)
                sum += by_seeds_[i * columns + j] * seeds[j * directions_ + d];
            if (d >= starts_count_)
                sum += by_seeds_[i * columns + states_ + 1 + d - starts_count_];
            seeds_[i * directions_ + d] = sum;
        }
    return ending;
}

void UniformisedFlow::load(const Series& series, double sign, double factor) {
    double power = factor;
    for (std::size_t k = 0; k < coefficients_.size(); ++k, power *= sign)
        coefficients_[k] = power * series[k];
}

/// Ends a phase on the side g > 0 at the wanted time, or where the root falls to zero.
bool UniformisedFlow::ends_inside(const Jet& jet, double& length, double wanted) {
    const double sign = length < 0 ? -1 : 1;
    double reach = std::abs(length);
    coefficients_.resize(static_cast<std::size_t>(jet.order()) + 1);
    Root found{};
    load(jet.series()[states_], sign, 1);
    reached_zero_ = finder_.first_falling(
        coefficients_, reach, first_step_ && coefficients_[0] == 0 ? RootStart::deflate : RootStart::as_is, found);
    if (reached_zero_)
        reach = found.at;
    load(jet.series()[states_ + 1], sign, -sign);
    coefficients_[0] += std::abs(wanted);
    reached_end_ = finder_.first_falling(coefficients_, reach, RootStart::as_is, found);
    if (reached_end_) {
        reach = found.at;
        reached_zero_ = false;
    }
    first_step_ = false;
    length = sign * reach;
    return reached_zero_ || reached_end_;
}

/// Ends a phase whose independent variable is the time where the radicand passes zero, or the margin beside it.
/// @param way -1 where it falls, 1 where it rises
bool UniformisedFlow::ends_in_time(const Jet& jet, double& length, std::size_t output, int way, bool at_zero) {
    const double sign = length < 0 ? -1 : 1;
    coefficients_.resize(static_cast<std::size_t>(jet.order()) + 1);
    load(jet.series()[states_ + 2 + output], sign, -way);
    coefficients_[0] += way * margin_;
    // A motion that starts on the zero without speed may be pressed beyond it: it has left when it is clearly beyond.
    if (first_step_ && way > 0 && !at_zero && coefficients_[0] <= 0) {
        margin_ = negligible_share * RootFinder::enclosure(coefficients_, std::abs(length), RootStart::as_is).size -
                  2 * coefficients_[0];
        coefficients_[0] += margin_;
    }
    Root found{};
    reached_zero_ = finder_.first_falling(coefficients_, std::abs(length),
                                          first_step_ && at_zero ? RootStart::deflate : RootStart::as_is, found);
    first_step_ = false;
    if (reached_zero_)
        length = sign * found.at;
    return reached_zero_;
}

ModeFlow::Ending UniformisedFlow::pass_inside(const UniformisedRoot& root, const Place& here, double duration,
                                              bool at_zero) {
    if (root.degree == 0)
        return pass_in_time(root.inside, root.output, -1, duration, at_zero);
    seed_inside(root, here, at_zero);
    // The root grows at the rate of the radicand; where it is large, time passes q y^(q-1) times as fast.
    const double speed = std::abs(here.rate), q = root.degree;
    const double largest = std::max(state_[states_], std::pow(speed * std::abs(duration), 1 / q));
    double longest = std::abs(duration) / (q * std::pow(largest, q - 1)) + (speed > 0 ? largest / speed : 0);
    longest = std::copysign(1e3 * longest, duration);
    first_step_ = true;
    reached_zero_ = reached_end_ = false;
    const auto ending = advance(root.inside, longest,
                                [&](const Jet& jet, double& length) { return ends_inside(jet, length, duration); });
    if (ending != ModeFlow::Ending::done)
        return ending;
    find_field(root, reached_zero_ ? 0 : state_[states_]);
    for (std::size_t i = 0; i < states_ && derived_; ++i)
        for (std::size_t d = 0; d < directions_; ++d)
            matrix_[i * directions_ + d] =
                seeds_[i * directions_ + d] - field_[i] * seeds_[(states_ + 1) * directions_ + d];
    time_ += state_[states_ + 1];
    return ending;
}

/// After a start without speed, the radicand is known to be small rather than zero.
void UniformisedFlow::end_touch() {
    if (margin_ > 0) {
        margin_ = 0;
        reached_zero_ = false;
    }
}

/// Passes a phase whose independent variable is the time: outside or, where there is no root to follow, inside.
/// @param way as of `ends_in_time`
ModeFlow::Ending UniformisedFlow::pass_in_time(std::size_t mode, std::size_t output, int way, double duration,
                                               bool at_zero) {
    state_[states_] = state_[states_ + 1] = 0;
    if (derived_) {
        std::fill(seeds_.begin(), seeds_.end(), 0.0);
        std::ranges::copy(matrix_, seeds_.begin());
    }
    first_step_ = true;
    reached_zero_ = reached_end_ = false;
    const auto ending = advance(mode, duration, [&](const Jet& jet, double& length) {
        return ends_in_time(jet, length, output, way, at_zero);
    });
    if (ending != ModeFlow::Ending::done)
        return ending;
    if (derived_)
        std::copy_n(seeds_.begin(), matrix_.size(), matrix_.begin());
    time_ = reached_zero_ ? time_ + state_[states_ + 1] : time_ + duration;
    return ending;
}

} // namespace graze
