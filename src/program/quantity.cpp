#include "program/quantity.hpp"

#include <algorithm>

namespace graze {

RequestedQuantity requested_quantity(const Model& model, const std::string& text, const std::string& option) {
    return named_value(model, text, {option + ' ' + text, 1, 1});
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
    for (const double value : model.parameter_values())
        inputs_.push_back(value);
    std::vector<Expression> outputs;
    for (const RequestedQuantity& quantity : quantities)
        outputs.push_back(quantity.value);
    function_ = model.function_of(outputs);
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
