#include "grazing/touch_geometry.hpp"

#include "base/concatenated.hpp"
#include "flow/lie_derivative.hpp"
#include "graze/symbolic/transform.hpp"

#include <cmath>

namespace graze {

namespace {

/// Relative tolerances below which values and rates count as zero; touches are located to about 1e-10.
constexpr double small_value = 1e-7;
constexpr double small_rate = 1e-6;
/// The same for gains, which cancel exactly where they are zero.
constexpr double small_gain = 1e-10;

} // namespace

TouchFunctions::TouchFunctions(const System& system, std::size_t mode, std::size_t event)
    : system_(system), mode_(mode), event_(event) {
    Model model = system.model(); // a copy, whose expression graph may grow
    const Expression function = model.expand(model.events[event].function);
    const std::vector<Expression> field = model.expand(model.modes[mode].rates);
    const Expression rate = lie_derivatives(model, std::span(&function, 1), field).front();
    const SymbolIndex inputs(model.inputs());
    std::vector<Function::Output> outputs{{0, rate}};
    for (JacobianEntry& entry : sparse_jacobian({&rate, 1}, inputs))
        outputs.push_back({1 + entry.column, std::move(entry.value)});
    outputs.push_back({1 + inputs.size(), lie_derivatives(model, std::span(&rate, 1), field).front()});
    rate_ = Function(inputs, 2 + inputs.size(), outputs, Function::Others::zero);
}

TouchGeometry TouchFunctions::at(std::span<const double> state, std::span<const double> parameters) const {
    const std::vector<double> inputs = concatenated(state, parameters);
    const std::vector<double> value = system_.event(event_)(inputs), rate = rate_(inputs),
                              field = system_.mode(mode_).rates(inputs);
    const Eigen::Index count = index(inputs.size());
    TouchGeometry result;
    result.value = value[0];
    result.gradient = Eigen::Map<const Eigen::VectorXd>(value.data() + 1, count);
    result.rate = rate[0];
    result.rate_gradient = Eigen::Map<const Eigen::VectorXd>(rate.data() + 1, count);
    result.acceleration = rate.back();
    result.field = vector_of(field);
    return result;
}

TouchSizes::TouchSizes(const TouchState& touch, const TouchGeometry& geometry) : scales_(vector_of(touch.scales)) {
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

Eigen::VectorXd TouchSizes::off_surface(const TouchGeometry& geometry) const {
    const Eigen::VectorXd h = geometry.gradient.head(scales_.size()).cwiseProduct(scales_),
                          v = geometry.rate_gradient.head(scales_.size()).cwiseProduct(scales_);
    const Eigen::VectorXd along = h - v * (h.dot(v) / v.squaredNorm());
    return along.cwiseProduct(scales_) / along.dot(h);
}

bool TouchSizes::is_zero_gain(const Eigen::VectorXd& gain) const {
    return (gain.cwiseQuotient(scales_) * speed_).cwiseAbs().maxCoeff() <= small_gain;
}

} // namespace graze
