#include "graze/flow/step_check.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/require.hpp"
#include "graze/flow/roots.hpp"
#include "graze/flow/step_size.hpp"

namespace graze {

namespace {

constexpr double roundoff_unit = 0x1p-53;
/// Factor of the bounds on round-off, which are first-order bounds for one evaluation: coefficients have round-off of
/// their own, which the recurrences amplify.
constexpr double roundoff_allowance = 16;
constexpr int most_attempts = 200;
/// Fractions of a step at which its interior is checked: not simple ones, so that nothing periodic can hide.
constexpr double first_inside = 0.3819, second_inside = 0.7071;

/// The sums of |c_k| |s|^k and of k |c_k| |s|^k.
struct Sizes {
    double value = 0, slope = 0;
};
Sizes sizes_at(const Series& c, std::size_t order, double s) {
    Sizes sizes;
    for (std::size_t k = order + 1; k-- > 0;) {
        sizes.slope = sizes.slope * s + sizes.value;
        sizes.value = sizes.value * s + std::abs(c[k]);
    }
    sizes.slope *= s;
    return sizes;
}

/// Returns the first of these sums.
double size_at(const Series& c, std::size_t order, double s) {
    double size = 0;
    for (std::size_t k = order + 1; k-- > 0;)
        size = size * s + std::abs(c[k]);
    return size;
}

/// Keeps the larger one; NaN counts as infinity.
void keep_most(double& most, double ratio) {
    most = std::isnan(ratio) ? infinity : std::max(most, ratio);
}

} // namespace

StepCheck::StepCheck(const System& system, int order, double tolerance)
    : system_(system), states_(system.states()), order_(static_cast<std::size_t>(order)), tolerance_(tolerance),
      inputs_(states_ + system.parameters()), input_errors_(inputs_.size()), slopes_(states_), seen_(states_) {
    require_order(order);
    require_tolerance(tolerance);
    std::size_t outputs = 0, workspace = 0;
    for (std::size_t m = 0; m < system.model().modes.size(); ++m) {
        outputs = std::max(outputs, system.mode(m).evidence.outputs());
        workspace = std::max(workspace, system.mode(m).evidence.workspace());
    }
    truth_.resize(outputs);
    errors_.resize(outputs);
    work_.resize(2 * workspace);
}

void StepCheck::set_parameters(std::span<const double> parameters) {
    require_size(parameters.size(), system_.parameters(), "independent parameters");
    std::copy(parameters.begin(), parameters.end(), inputs_.begin() + static_cast<std::ptrdiff_t>(states_));
}

/// Evaluates the polynomials of the states at s, and the model there.
void StepCheck::evaluate(std::size_t mode, double s) {
    for (std::size_t i = 0; i < states_; ++i) {
        double value = series_[i][order_], slope = value;
        for (std::size_t k = order_; k-- > 1;) {
            value = value * s + series_[i][k];
            slope = slope * s + value;
        }
        inputs_[i] = value * s + series_[i][0];
        slopes_[i] = slope;
    }
    mode_ = mode;
    errors_known_ = false;
    system_.mode(mode).evidence.evaluate(inputs_, truth_, work_);
}

/// Bounds the effect of round-off on the model's values.
void StepCheck::find_errors(double s) {
    if (errors_known_)
        return;
    errors_known_ = true;
    for (std::size_t i = 0; i < states_; ++i)
        input_errors_[i] = 4 * roundoff_unit * size_at(series_[i], order_, std::abs(s));
    system_.mode(mode_).evidence.error_bounds(inputs_, input_errors_, errors_, work_);
}

/// Returns the size of a state. If value, rate and acceleration are zero at the start, it is the size reached in a
/// longer step: initial errors are small compared to it.
double StepCheck::size_of_state(std::size_t i, double s) const {
    const Series& c = series_[i];
    double size = size_over(c[0], c[1], inputs_[i], truth_[i], s);
    if (c[0] == 0 && c[1] == 0 && c[2] == 0)
        size = std::max({seen_[i], size_at(c, order_, s), smallest_size});
    return floors_.empty() ? size : std::max(size, floors_[i]);
}

double StepCheck::misfit_of_rates(double s) {
    double most = 0;
    const double length = std::abs(s);
    for (std::size_t i = 0; i < states_; ++i) {
        const double difference = std::abs(slopes_[i] - truth_[i]) * length;
        if (difference == 0)
            continue;
        double allowed = allowance * tolerance_ * size_of_state(i, length);
        if (!(difference <= allowed)) {
            find_errors(s);
            allowed +=
                roundoff_allowance * (length * errors_[i] + roundoff_unit * sizes_at(series_[i], order_, length).slope);
        }
        keep_most(most, difference / allowed);
    }
    return most;
}

double StepCheck::misfit_of_values(double s) {
    double most = 0;
    const double length = std::abs(s);
    for (std::size_t j = states_; j < series_.size(); ++j) {
        const Series& c = series_[j];
        const double value = evaluate_polynomial(c, order_ + 1, s), difference = std::abs(value - truth_[j]);
        if (difference == 0)
            continue;
        const double sum = size_at(c, order_, length),
                     first = std::abs(c[0]) + length * (std::abs(c[1]) + length * std::abs(c[2]));
        const double size = std::max(first > 0 ? first : sum, floors_.empty() ? 0 : floors_[j]);
        double allowed = value_allowance * tolerance_ * (size + smallest_size);
        if (!(difference <= allowed)) {
            find_errors(s);
            allowed += roundoff_allowance * (errors_[j] + roundoff_unit * sum);
        }
        keep_most(most, difference / allowed);
    }
    return most;
}

/// If terms are far larger than their sum, the sum consists of round-off.
double StepCheck::misfit_of_sums(double s) {
    double most = 0;
    const double length = std::abs(s);
    for (std::size_t i = 0; i < states_; ++i) {
        const double size = size_of_state(i, length);
        if (const double noise = 4 * roundoff_unit * size_at(series_[i], order_, length); noise > 0)
            keep_most(most, noise / (std::max(tolerance_, 64 * roundoff_unit) * size));
    }
    return most;
}

double StepCheck::longest(std::size_t mode, std::span<const Series> series, double length, bool inside,
                          std::span<const double> floors) {
    const std::size_t needed = system_.mode(mode).evidence.outputs();
    // Without events only the series of states are given.
    if (series.size() != states_)
        require_room(series.size(), needed, "series");
    if (!floors.empty())
        require_room(floors.size(), series.size(), "floors of series");
    series_ = series.first(std::min(series.size(), needed)); // the model has no values for further series
    floors_ = floors;
    std::fill(seen_.begin(), seen_.end(), 0.0);
    const double last_power = -1.0 / static_cast<double>(order_ + 1);
    double s = length;
    for (int attempt = 0; attempt < most_attempts && s != 0; ++attempt) {
        double most = 0;
        for (const double share : {1.0, second_inside, first_inside}) {
            if (share < 1 && !inside)
                break;
            const double at = share * s;
            evaluate(mode, at);
            for (std::size_t i = 0; i < states_; ++i)
                if (const double reached = std::abs(at * truth_[i]); std::isfinite(reached))
                    seen_[i] = std::max(seen_[i], reached);
            keep_most(most, misfit_of_rates(at));
            keep_most(most, misfit_of_values(at));
            if (inside)
                keep_most(most, misfit_of_sums(at));
        }
        if (most <= 1)
            return s;
        s *= std::isfinite(most) ? std::clamp(0.9 * std::pow(most, last_power), 0.1, 0.8) : 0.3;
    }
    return 0;
}

} // namespace graze
