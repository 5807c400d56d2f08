#include "program/quantity.hpp"

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
