#include "grazing/next_order.hpp"

#include "flow/lie_derivative.hpp"
#include "graze/symbolic/transform.hpp"
#include "orbit/eigen_index.hpp"

#include <vector>

namespace graze {

namespace {

/// Derivatives at a touch of the field F, of the jump J and of the touched function.
struct Derivatives {
    Eigen::VectorXd curve;       ///< derivative of F along F
    Eigen::MatrixXd of_field;    ///< Jacobian of F, states x states
    Eigen::MatrixXd of_jump;     ///< Jacobian of J minus the identity
    Eigen::VectorXd second_jump; ///< second derivative of J along F
    double jerk = 0;             ///< third time derivative of the touched function
};

Derivatives derivatives_at(const System& system, const TouchState& touch, std::size_t transition) {
    Model model = system.model();
    const std::size_t n = system.states();
    const std::vector<Expression> field = model.expand(model.modes[touch.mode].rates),
                                  jump = model.expand(
                                      std::vector<Expression>(model.jumps[model.transitions[transition].jump].map));
    std::vector<Expression> outputs = lie_derivatives(model, field, field);
    const std::vector<Expression> second = lie_derivatives(model, lie_derivatives(model, jump, field), field);
    outputs.insert(outputs.end(), second.begin(), second.end());
    std::vector<Expression> rate{model.expand(model.events[touch.event].function)};
    for (int order = 0; order < 3; ++order)
        rate = lie_derivatives(model, rate, field);
    outputs.push_back(rate.front());
    const SymbolIndex states(model.state_symbols());
    const auto of_field = sparse_jacobian(field, states), of_jump = sparse_jacobian(jump, states);
    for (const auto* entries : {&of_field, &of_jump})
        for (const JacobianEntry& entry : *entries)
            outputs.push_back(entry.value);
    std::vector<double> inputs = touch.state;
    inputs.insert(inputs.end(), touch.parameters.begin(), touch.parameters.end());
    const std::vector<double> values = Function(model.inputs(), outputs)(inputs);

    Derivatives result;
    result.curve = Eigen::Map<const Eigen::VectorXd>(values.data(), index(n));
    result.second_jump = Eigen::Map<const Eigen::VectorXd>(values.data() + n, index(n));
    result.jerk = values[2 * n];
    result.of_field = Eigen::MatrixXd::Zero(index(n), index(n));
    result.of_jump = -Eigen::MatrixXd::Identity(index(n), index(n));
    std::size_t place = 2 * n + 1;
    for (const JacobianEntry& entry : of_field)
        result.of_field(index(entry.row), index(entry.column)) = values[place++];
    for (const JacobianEntry& entry : of_jump)
        result.of_jump(index(entry.row), index(entry.column)) += values[place++];
    return result;
}

} // namespace

/// The motion reaches the surface at the time -s/a - j s^2/(6 a^3), with j the third rate of the function. There K = J
/// - 1, which is zero on the touching states, shifts it. The shift is carried by the field to time 0 and compared
/// there. All terms are expanded to order s^2; the motion lies off the surface by the depth s^2/(2 a).
std::optional<Eigen::VectorXd> next_order_of_impact(const TouchFunctions& functions, const TouchState& touch,
                                                    const TouchGeometry& geometry, const TouchSizes& sizes,
                                                    std::size_t transition) {
    const Derivatives at = derivatives_at(functions.system(), touch, transition);
    const double a = geometry.acceleration;
    const Eigen::VectorXd first = at.of_jump * geometry.field; // derivative of K along F
    const Eigen::VectorXd bent =
        (at.second_jump - at.curve) / 2; // second derivative of K along the motion, divided by 2
    const Eigen::VectorXd carried = at.of_field * first;
    const Eigen::VectorXd result = -first * (at.jerk / (6 * a * a * a)) + (bent - carried) / (a * a) -
                                   at.of_jump * sizes.off_surface(geometry) / (2 * a);
    return result.allFinite() ? std::optional(result) : std::nullopt;
}

} // namespace graze
