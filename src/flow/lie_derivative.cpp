#include "flow/lie_derivative.hpp"

#include "graze/symbolic/transform.hpp"

namespace graze {

std::vector<Expression> lie_derivatives(const Model& model, std::span<const Expression> functions,
                                        std::span<const Expression> rates) {
    const auto states = model.state_symbols();
    std::vector<Component> field;
    for (std::size_t i = 0; i < states.size(); ++i)
        field.emplace_back(states[i], rates[i]);
    return differentiate_along(functions, field);
}

std::vector<Expression> rates_of(const System& system, std::size_t mode, std::size_t event, std::size_t count) {
    Model model = system.model();
    std::vector<Expression> result{model.expand(model.events[event].function)};
    const auto rates = model.expand(model.modes[mode].rates);
    for (std::size_t k = 0; k < count; ++k)
        result.push_back(lie_derivatives(model, std::span(&result.back(), 1), rates).front());
    result.erase(result.begin());
    return result;
}

Expression rate_of(const System& system, std::size_t mode, std::size_t event) {
    return rates_of(system, mode, event, 1).front();
}

} // namespace graze
