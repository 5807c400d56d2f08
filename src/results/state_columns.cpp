#include "graze/results/state_columns.hpp"

namespace graze {

StateColumns::StateColumns(const Model& model, const std::vector<NamedValue>& quantities)
    : evaluate_(model, quantities) {
    for (const State& state : model.states)
        columns_.push_back({state.name, state.unit});
    for (const NamedValue& quantity : quantities)
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
