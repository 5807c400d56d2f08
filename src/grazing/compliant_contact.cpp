#include "grazing/compliant_contact.hpp"

#include "flow/lie_derivative.hpp"
#include "graze/symbolic/transform.hpp"
#include "orbit/eigen_index.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

namespace {

/// The difference of two fields at a state, with derivatives.
struct FieldDifference {
    Eigen::VectorXd value, second; ///< and its second derivative along the field
    double jerk = 0;               ///< third rate of the touched function
    Eigen::MatrixXd derivatives;   ///< states x states
    Eigen::MatrixXd of_field;      ///< of the touching mode's field
};

FieldDifference difference_of(const System& system, const TouchState& touch, std::size_t mode) {
    Model model = system.model();
    const std::size_t n = system.states();
    const auto own = model.expand(model.modes[touch.mode].rates), other = model.expand(model.modes[mode].rates);
    std::vector<Expression> outputs;
    for (std::size_t i = 0; i < n; ++i)
        outputs.push_back(other[i] - own[i]);
    const std::vector<Expression> difference = outputs;
    const std::vector<Expression> second = lie_derivatives(model, lie_derivatives(model, difference, own), own);
    outputs.insert(outputs.end(), second.begin(), second.end());
    const SymbolIndex states(model.state_symbols());
    const auto of_difference = sparse_jacobian(difference, states), of_field = sparse_jacobian(own, states);
    for (const auto* entries : {&of_difference, &of_field})
        for (const JacobianEntry& entry : *entries)
            outputs.push_back(entry.value);
    std::vector<Expression> rate{model.expand(model.events[touch.event].function)};
    for (int order = 0; order < 3; ++order)
        rate = lie_derivatives(model, rate, own);
    outputs.push_back(rate.front());
    std::vector<double> inputs = touch.state;
    inputs.insert(inputs.end(), touch.parameters.begin(), touch.parameters.end());
    const std::vector<double> values = Function(model.inputs(), outputs)(inputs);
    FieldDifference result;
    result.value = Eigen::Map<const Eigen::VectorXd>(values.data(), index(n));
    result.second = Eigen::Map<const Eigen::VectorXd>(values.data() + n, index(n));
    result.derivatives = result.of_field = Eigen::MatrixXd::Zero(index(n), index(n));
    std::size_t place = 2 * n;
    for (const JacobianEntry& entry : of_difference)
        result.derivatives(index(entry.row), index(entry.column)) = values[place++];
    for (const JacobianEntry& entry : of_field)
        result.of_field(index(entry.row), index(entry.column)) = values[place++];
    result.jerk = values[place];
    return result;
}

} // namespace

CompliantContact compliant_contact(const TouchFunctions& functions, const TouchState& touch,
                                   const TouchGeometry& geometry, const TouchSizes& sizes, std::size_t mode) {
    constexpr double small = 1e-6;
    const Eigen::Index n = index(touch.state.size());
    const FieldDifference difference = difference_of(functions.system(), touch, mode);
    const std::string& name = functions.system().model().modes[mode].name;
    CompliantContact result;
    const auto fail = [&](std::string reason) {
        result.reason = std::move(reason);
        return result;
    };
    const Eigen::VectorXd& units = sizes.scales();
    const double force = (difference.value.cwiseQuotient(units) * sizes.time()).norm();
    if (!difference.derivatives.allFinite() || !difference.second.allFinite() || !(force <= small))
        return fail(fmt::format("the field of mode '{}' is another one at the touch", name));
    const double a = geometry.acceleration;
    const Eigen::VectorXd gradient = geometry.gradient.head(n), rate_gradient = geometry.rate_gradient.head(n);
    const Eigen::VectorXd damping = difference.derivatives * geometry.field / a;
    // A direction in which the function grows and its rate does not, in units of the states.
    Eigen::VectorXd h = gradient.cwiseProduct(units), v = rate_gradient.cwiseProduct(units);
    Eigen::VectorXd along = h - v * (h.dot(v) / v.squaredNorm());
    along = along.cwiseProduct(units) / along.dot(h);
    const Eigen::VectorXd stiffness = difference.derivatives * along;
    const Eigen::MatrixXd rest =
        units.cwiseInverse().asDiagonal() *
        (difference.derivatives - stiffness * gradient.transpose() - damping * rate_gradient.transpose()) *
        units.asDiagonal();
    const Eigen::MatrixXd whole = units.cwiseInverse().asDiagonal() * difference.derivatives * units.asDiagonal();
    if (!(whole.norm() > 0))
        return fail("the contact changes nothing");
    if (!(rest.norm() <= small * whole.norm()))
        return fail(fmt::format("the field of mode '{}' is not that of mode '{}' wherever the surface is touched", name,
                                functions.system().model().modes[touch.mode].name));
    if (!(std::abs(gradient.dot(damping)) <= small))
        return fail(fmt::format("mode '{}' changes the rate of event '{}'", name,
                                functions.system().model().events[touch.event].name));
    const Eigen::VectorXd bracket = difference.second - 2 * a * (difference.of_field * damping);
    // By the third power of half the time T beyond the surface. Damping also acts while the motion is not back yet at
    // its first depth: a (t^2 - T^2)/2 at the end, as the function's third rate and what it has gained make it.
    const Eigen::VectorXd by_force = -a * stiffness + bracket / 3;
    const double late = difference.jerk / 3 + gradient.dot(by_force) + 2 * a / 3 * rate_gradient.dot(damping);
    const Eigen::VectorXd by_time = by_force - late * damping;
    result.gain = by_time * std::pow(2 / a, 1.5);
    return result;
}

} // namespace graze
