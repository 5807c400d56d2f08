#include "graze/model/model.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "model/model_completion.hpp"
#include "model/model_expressions.hpp"
#include "model/model_validate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Returns the index of the named item. @throws InputError with the nearest name
template <typename Item>
std::size_t require_named(const std::vector<Item>& items, std::string_view name, const char* kind) {
    if (const auto index = find_named(items, name))
        return *index;
    std::vector<std::string> names;
    for (const Item& item : items)
        names.push_back(item.name);
    throw InputError(fmt::format("there is no {} '{}'", kind, name), name_remedy(name, names));
}

} // namespace

Model::Model() {
    graph = Graph::create();
    jumps.push_back({"identity", "states stay as they are", {}});
}

Model::Model(const Model& other) : ModelItems(other) {
    if (!graph)
        return; // the other model has been moved from
    graph = graph->copy();
    visit_expressions(*this, [&](Expression& expression) {
        if (expression.graph() == other.graph) // `validate` reports foreign expressions
            expression = Expression(graph, expression.index());
    });
}

Model& Model::operator=(const Model& other) {
    if (this != &other)
        *this = Model(other);
    return *this;
}

void Model::freeze() {
    // A frozen graph must already contain all symbols, since names are looked up in it.
    for (const State& state : states)
        symbol(state.name);
    for (const Parameter& parameter : parameters)
        symbol(parameter.name);
    for (const Definition& definition : definitions)
        symbol(definition.name);
    graph->freeze();
}

std::vector<Expression> Model::state_symbols() const {
    std::vector<Expression> result;
    for (const State& state : states)
        result.push_back(symbol(state.name));
    return result;
}

std::vector<Expression> Model::parameter_symbols() const {
    std::vector<Expression> result;
    for (const Parameter& parameter : parameters)
        if (!parameter.expression)
            result.push_back(symbol(parameter.name));
    return result;
}

std::vector<Expression> Model::inputs() const {
    std::vector<Expression> result = state_symbols();
    for (const Expression& parameter : parameter_symbols())
        result.push_back(parameter);
    return result;
}

std::vector<double> Model::parameter_values() const {
    std::vector<double> result;
    for (const Parameter& parameter : parameters)
        if (!parameter.expression)
            result.push_back(parameter.value.value_or(std::nan("")));
    return result;
}

std::vector<std::string> Model::independent_parameters() const {
    std::vector<std::string> names;
    for (const Parameter& parameter : parameters)
        if (!parameter.expression)
            names.push_back(parameter.name);
    return names;
}

std::optional<ParameterId> Model::find_independent_parameter(std::string_view item) const {
    const std::vector<std::string> names = independent_parameters();
    const auto found = std::find(names.begin(), names.end(), item);
    if (found == names.end())
        return std::nullopt;
    return ParameterId(static_cast<std::size_t>(found - names.begin()));
}

ParameterId Model::independent_parameter(std::string_view item) const {
    if (const auto place = find_independent_parameter(item))
        return *place;
    if (find_parameter(item))
        throw InputError(fmt::format("parameter '{}' follows from others", item), "choose one that it depends on");
    throw InputError(fmt::format("there is no parameter '{}'", item), name_remedy(item, independent_parameters()));
}

std::string Model::parameter_unit(std::string_view name) const {
    const auto place = find_parameter(name);
    return place ? parameters[*place].unit : "";
}

const Transition* Model::find_transition(std::size_t mode, std::size_t event) const {
    const auto found = std::find_if(transitions.begin(), transitions.end(),
                                    [&](const Transition& t) { return t.mode == mode && t.event == event; });
    return found == transitions.end() ? nullptr : &*found;
}

void Model::set_parameter(std::string_view item, double value) {
    Parameter& parameter = parameters[require_named(parameters, item, "parameter")];
    if (parameter.expression)
        throw InputError(fmt::format("the parameter '{}' follows from others and cannot be set", item),
                         "set the parameters that it depends on");
    require_finite(value, fmt::format("the value of parameter '{}'", item));
    parameter.value = value;
    choose_initial_mode(*this);
}

void Model::set_initial(std::string_view item, double value) {
    State& state = states[require_named(states, item, "state")];
    require_finite(value, fmt::format("the value of state '{}'", item));
    state.initial = graph->number(value);
    choose_initial_mode(*this);
}

void Model::set_initial_mode(std::string_view item) {
    initial_mode = require_named(modes, item, "mode");
    initial_modes.clear();
}

std::vector<double> Model::initial_state() const {
    return checked_initial_state(*this, Places(name));
}

std::vector<double> Model::periods() const {
    std::vector<Expression> periods;
    const Expression none = Graph::create()->number(0);
    for (const State& state : states)
        periods.push_back(state.period.value_or(none));
    return values_of(periods);
}

void Model::validate() const {
    if (!graph)
        throw InputError("a model without a graph has no expressions", "do not use a model that was moved from");
    validate_model(*this, Places(name));
}

} // namespace graze
