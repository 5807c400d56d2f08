#pragma once

#include "graze/model/model.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/transform.hpp"

#include <random>
#include <span>
#include <vector>

namespace graze::testing {

/// Expressions of a model as a function of its states, at the model's present parameters.
class ModelFunction {
public:
    ModelFunction(const Model& model, std::span<const Expression> expressions)
        : parameters_(model.parameter_values()), function_(model.function_of(expressions)) {}

    std::vector<double> operator()(std::span<const double> state) const {
        std::vector<double> inputs(state.begin(), state.end());
        inputs.insert(inputs.end(), parameters_.begin(), parameters_.end());
        return function_(inputs);
    }

private:
    std::vector<double> parameters_;
    Function function_;
};

inline std::vector<double> evaluate(const Model& model, std::span<const Expression> expressions,
                                    std::span<const double> state) {
    return ModelFunction(model, expressions)(state);
}

inline double evaluate(const Model& model, const Expression& expression, std::span<const double> state) {
    return evaluate(model, {&expression, 1}, state).front();
}

/// Returns the rate of change of an expression along the motion in a mode.
inline Expression rate_of(Model model, const Expression& expression, std::size_t mode) {
    const Expression expanded = model.expand(expression);
    Expression sum = model.graph->number(0);
    for (std::size_t i = 0; i < model.states.size(); ++i) {
        const Expression slope = differentiate(expanded, model.symbol(model.states[i].name));
        sum = sum + slope * model.expand(model.modes[mode].rates[i]);
    }
    return sum;
}

/// Returns all expressions of a model that determine the motion.
inline std::vector<Expression> expressions_of(const Model& model) {
    std::vector<Expression> all;
    const auto append = [&](const std::vector<Expression>& more) { all.insert(all.end(), more.begin(), more.end()); };
    for (const Mode& mode : model.modes)
        append(mode.rates);
    for (const Event& event : model.events)
        all.push_back(event.function);
    for (const Jump& jump : model.jumps)
        append(jump.map);
    for (const Transition& transition : model.transitions)
        for (const Alternative& alternative : transition.next)
            for (const Condition& condition : alternative.when)
                all.push_back(condition.function);
    for (const Section& section : model.sections)
        all.push_back(section.state ? section.value : section.function);
    for (const Quantity& quantity : model.quantities)
        all.push_back(quantity.value);
    return all;
}

/// A state drawn uniformly from a box about zero.
inline std::vector<double> random_state(const Model& model, double size, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-size, size);
    std::vector<double> state;
    for (std::size_t i = 0; i < model.states.size(); ++i)
        state.push_back(uniform(random));
    return state;
}

} // namespace graze::testing
