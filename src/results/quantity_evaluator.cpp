#include "graze/results/quantity_evaluator.hpp"

#include "graze/base/require.hpp"

#include <algorithm>

namespace graze {

QuantityEvaluator::QuantityEvaluator(const Model& model, const std::vector<NamedValue>& quantities)
    : states_(model.states.size()), inputs_(states_), values_(quantities.size()) {
    for (const double value : model.parameter_values())
        inputs_.push_back(value);
    if (quantities.empty())
        return;
    std::vector<Expression> outputs;
    for (const NamedValue& quantity : quantities)
        outputs.push_back(quantity.value);
    function_ = model.function_of(outputs);
    work_.resize(function_.workspace());
}

void QuantityEvaluator::set_parameters(std::span<const double> values) {
    require_size(values.size(), inputs_.size() - states_, "parameters");
    std::ranges::copy(values, inputs_.begin() + static_cast<std::ptrdiff_t>(states_));
}

std::span<const double> QuantityEvaluator::operator()(std::span<const double> state) {
    if (values_.empty())
        return {};
    std::copy_n(state.begin(), states_, inputs_.begin());
    function_.evaluate(inputs_, values_, work_);
    return values_;
}

StateColumns::StateColumns(const Model& model, const std::vector<NamedValue>& quantities)
    : evaluate_(model, quantities) {
    for (const State& state : model.states)
        columns_.push_back({state.name, state.unit});
    for (const NamedValue& quantity : quantities)
        columns_.push_back({quantity.name, quantity.unit});
}

std::vector<Table::Column> StateColumns::after(std::vector<Table::Column> columns, const std::string& suffix) const {
    for (const Table::Column& column : columns_)
        columns.push_back({column.name + suffix, column.unit});
    return columns;
}

void StateColumns::add(Table& table, std::span<const double> state) {
    for (const double value : state)
        table.add(value);
    for (const double value : evaluate_(state))
        table.add(value);
}

} // namespace graze
