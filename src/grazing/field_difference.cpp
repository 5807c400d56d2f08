#include "grazing/field_difference.hpp"

#include "flow/lie_derivative.hpp"
#include "graze/symbolic/transform.hpp"
#include "orbit/eigen_index.hpp"

#include <vector>

namespace graze {

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

} // namespace graze
