#include "program/quantity.hpp"

#include "graze/symbolic/parser.hpp"

#include <algorithm>

namespace graze {

namespace {

Scope scope_of(const Model& model) {
    Scope scope;
    for (const Quantity& quantity : model.quantities)
        scope.insert_or_assign(quantity.name, quantity.value);
    for (const Parameter& parameter : model.parameters)
        scope.insert_or_assign(parameter.name, model.symbol(parameter.name));
    for (const State& state : model.states)
        scope.insert_or_assign(state.name, model.symbol(state.name));
    for (const Definition& definition : model.definitions)
        scope.insert_or_assign(definition.name, model.symbol(definition.name));
    return scope;
}

} // namespace

RequestedQuantity requested_quantity(const Model& model, const std::string& text, const std::string& option) {
    if (const auto index = model.find_quantity(text)) {
        const Quantity& quantity = model.quantities[*index];
        return {quantity.name, quantity.unit, quantity.text, model.expand(quantity.value)};
    }
    RequestedQuantity result{text, "", "", {}};
    const Place place{option + ' ' + text, 1, 1};
    result.value = model.expand(parse_expression(*model.graph, text, scope_of(model), place));
    if (const auto state = model.find_state(text)) {
        result.unit = model.states[*state].unit;
        result.text = model.states[*state].text;
    } else if (const auto parameter = model.find_parameter(text)) {
        result.unit = model.parameters[*parameter].unit;
        result.text = model.parameters[*parameter].text;
    }
    return result;
}

std::vector<RequestedQuantity> requested_quantities(const Model& model, const std::vector<std::string>& texts,
                                                    const std::string& option) {
    std::vector<RequestedQuantity> result;
    for (const std::string& text : texts)
        result.push_back(requested_quantity(model, text, option));
    return result;
}

QuantityEvaluator::QuantityEvaluator(const Model& model, const std::vector<RequestedQuantity>& quantities)
    : states_(model.states.size()), inputs_(states_), values_(quantities.size()) {
    std::vector<Expression> symbols = model.state_symbols();
    for (const Expression& symbol : model.parameter_symbols())
        symbols.push_back(symbol);
    for (const double value : model.parameter_values())
        inputs_.push_back(value);
    std::vector<Expression> outputs;
    for (const RequestedQuantity& quantity : quantities)
        outputs.push_back(quantity.value);
    function_ = Function(symbols, outputs);
    work_.resize(function_.workspace());
}

std::span<const double> QuantityEvaluator::operator()(std::span<const double> state) {
    std::copy_n(state.begin(), states_, inputs_.begin());
    function_.evaluate(inputs_, values_, work_);
    return values_;
}

StateColumns::StateColumns(const Model& model, const std::vector<RequestedQuantity>& quantities)
    : evaluate_(model, quantities) {
    for (const State& state : model.states)
        columns_.push_back({state.name, state.unit});
    for (const RequestedQuantity& quantity : quantities)
        columns_.push_back({quantity.name, quantity.unit});
}

void StateColumns::declare(std::vector<Table::Column>& columns, const std::string& suffix) const {
    for (const Table::Column& column : columns_)
        columns.push_back({column.name + suffix, column.unit});
}

void StateColumns::add(Table& table, std::span<const double> state) {
    for (const double value : state)
        table.add(value);
    for (const double value : evaluate_(state))
        table.add(value);
}

} // namespace graze
