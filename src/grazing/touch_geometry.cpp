#include "grazing/touch_geometry.hpp"

#include "flow/lie_derivative.hpp"
#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace graze {

namespace {

/// Shares of their sizes below which values count as zero: touches are located to some 1e-10.
constexpr double small_value = 1e-7;
constexpr double small_rate = 1e-6;
/// The same of what cancels exactly where it is zero.
constexpr double small_gain = 1e-10;

} // namespace

TouchFunctions::TouchFunctions(const System& system, std::size_t mode, std::size_t event)
    : system_(system), mode_(mode), event_(event) {
    const std::vector<Expression> rates = rates_of(system, mode, event, 3);
    rate_ = system.with_gradient(rates[0]);
    further_ = system.function_of(std::array{rates[1], rates[2]});
}

TouchGeometry TouchFunctions::at(std::span<const double> state, std::span<const double> parameters) const {
    std::vector<double> inputs(state.begin(), state.end());
    inputs.insert(inputs.end(), parameters.begin(), parameters.end());
    const std::vector<double> value = system_.event(event_)(inputs), rate = rate_(inputs), further = further_(inputs),
                              field = system_.mode(mode_).rates(inputs);
    TouchGeometry result;
    const auto gradient_of = [](const std::vector<double>& values) -> Eigen::VectorXd {
        return Eigen::Map<const Eigen::VectorXd>(values.data() + 1, index(values.size() - 1));
    };
    result.value = value[0];
    result.gradient = gradient_of(value);
    result.rate = rate[0];
    result.rate_gradient = gradient_of(rate);
    result.acceleration = further[0];
    result.jerk = further[1];
    result.field = Eigen::Map<const Eigen::VectorXd>(field.data(), index(field.size()));
    return result;
}

TouchSizes::TouchSizes(const TouchState& touch, const TouchGeometry& geometry)
    : scales_(Eigen::Map<const Eigen::VectorXd>(touch.scales.data(), index(touch.scales.size()))) {
    const double size = geometry.gradient.head(scales_.size()).cwiseAbs().dot(scales_);
    const double acceleration = std::abs(geometry.acceleration);
    time_ = acceleration > 0 && size > 0 ? std::sqrt(size / acceleration) : 1;
    speed_ = size / time_;
}

bool TouchSizes::is_zero(double value, const Eigen::VectorXd& gradient) const {
    return std::abs(value) <= small_value * gradient.head(scales_.size()).cwiseAbs().dot(scales_);
}

bool TouchSizes::is_zero_rate(double rate, const Eigen::VectorXd& gradient, const Eigen::VectorXd& field) const {
    const Eigen::VectorXd rates = field.cwiseAbs().cwiseMax(scales_ / time_);
    return std::abs(rate) <= small_rate * gradient.head(scales_.size()).cwiseAbs().dot(rates);
}

bool TouchSizes::is_zero_gain(double gain, const Eigen::VectorXd& gradient) const {
    return std::abs(gain) * speed_ <= small_gain * gradient.head(scales_.size()).cwiseAbs().dot(scales_);
}

bool TouchSizes::is_zero_gain(const Eigen::VectorXd& gain) const {
    return (gain.cwiseQuotient(scales_) * speed_).cwiseAbs().maxCoeff() <= small_gain;
}

} // namespace graze
