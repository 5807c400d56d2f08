#include "model/check_symmetry.hpp"

#include "base/concatenated.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace graze {

namespace {

/// Returns both sides of DS(x) f(x) = f'(S(x)), where f' is the vector field of the image of the mode: first all
/// components of the left side, then those of the right side.
Function both_sides(Model model, const Symmetry& symmetry, std::size_t mode) {
    const std::vector<Expression> states = model.state_symbols();
    const std::vector<Expression> map = model.expand(symmetry.map);
    const std::vector<Expression> rates = model.expand(model.modes[mode].rates);
    std::vector<Component> along;
    for (std::size_t i = 0; i < states.size(); ++i)
        along.emplace_back(states[i], rates[i]);
    std::vector<Expression> sides = differentiate_along(map, along);
    std::vector<Replacement> replacements;
    for (std::size_t i = 0; i < states.size(); ++i)
        replacements.emplace_back(states[i], map[i]);
    for (const Expression& rate : substitute(model.expand(model.modes[symmetry.modes[mode]].rates), replacements))
        sides.push_back(rate);
    return {model.inputs(), sides};
}

/// Returns a fixed set of states around the initial one, at distances relative to the size of each state.
std::vector<std::vector<double>> probes(const Model& model) {
    const std::vector<double> initial = model.initial_state();
    const std::vector<double> parameters = model.parameter_values();
    std::vector<std::vector<double>> result;
    double turn = 0;
    for (const double distance : {1e-6, 1e-4, 1e-2, 1.0}) {
        std::vector<double> state;
        for (const double value : initial) {
            turn += 2.4; // the golden angle: values that do not repeat
            state.push_back(value + distance * std::sin(turn));
        }
        result.push_back(concatenated(state, parameters));
    }
    return result;
}

/// Returns the first state whose rate the symmetry does not map to the rate in the image mode.
std::optional<std::size_t> broken_rate(const Model& model, const Symmetry& symmetry, std::size_t mode) {
    constexpr double tolerance = 1e-6; // far above round-off, far below a wrong sign
    const Function sides = both_sides(model, symmetry, mode);
    const std::size_t count = model.states.size();
    for (const std::vector<double>& inputs : probes(model)) {
        const std::vector<double> values = sides(inputs);
        if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
            continue; // outside the model's domain
        for (std::size_t i = 0; i < count; ++i)
            if (std::abs(values[i] - values[count + i]) >
                tolerance * std::max(std::abs(values[i]), std::abs(values[count + i])))
                return i;
    }
    return std::nullopt;
}

} // namespace

std::vector<std::string> symmetry_warnings(const Model& model) {
    std::vector<std::string> result;
    for (const Symmetry& symmetry : model.symmetries)
        for (std::size_t mode = 0; mode < model.modes.size(); ++mode)
            if (const auto state = broken_rate(model, symmetry, mode))
                result.push_back(
                    fmt::format("the symmetry '{}' does not hold: it does not take the rate of '{}' in mode "
                                "'{}' to that in mode '{}'",
                                symmetry.name, model.states[*state].name, model.modes[mode].name,
                                model.modes[symmetry.modes[mode]].name));
    return result;
}

} // namespace graze
