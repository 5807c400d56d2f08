#include "flow/modes_with_tangents.hpp"

#include <algorithm>

namespace graze {

Expression new_symbol(Model& model, const std::string& base) {
    std::string name = base;
    const auto is_definition = [&](const Definition& definition) { return definition.name == name; };
    while (model.find_state(name) || model.find_parameter(name) ||
           std::any_of(model.definitions.begin(), model.definitions.end(), is_definition))
        name += '_';
    return model.symbol(name);
}

System modes_with_tangents(Model& model, std::span<const std::size_t> rows,
                           std::span<const std::vector<Component>> columns) {
    Model grown;
    grown.graph = model.graph;
    grown.name = model.name;
    const auto add_state = [&](const Expression& symbol) {
        grown.states.push_back({.name = symbol.name(), .initial = model.number(0)});
    };
    for (const Expression& state : model.state_symbols())
        add_state(state);
    const std::vector<double> values = model.parameter_values();
    for (const Expression& parameter : model.parameter_symbols())
        grown.parameters.push_back({.name = parameter.name(), .value = values[grown.parameters.size()]});
    for (const std::vector<Component>& column : columns)
        for (std::size_t k = 0; k < column.size(); ++k)
            if (const Expression& component = column[k].second; k < rows.size())
                add_state(component);
            else
                grown.parameters.push_back({.name = component.name(), .value = 0.0});
    for (const Mode& mode : model.modes) {
        std::vector<Expression> rates = model.expand(mode.rates), moving;
        for (const std::size_t row : rows)
            moving.push_back(rates[row]);
        for (const std::vector<Component>& column : columns) {
            const std::vector<Expression> along = differentiate_along(moving, column);
            rates.insert(rates.end(), along.begin(), along.end());
        }
        grown.modes.push_back({.name = mode.name, .rates = std::move(rates)});
    }
    return System(grown);
}

} // namespace graze
