#pragma once

#include "graze/model/named_value.hpp"
#include "graze/results/quantity_evaluator.hpp"
#include "program/table.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// What a user wants to see of a state.
using RequestedQuantity = NamedValue;

/// @param option where it was asked for, for messages
/// @throws InputError with the place when it is no expression
RequestedQuantity requested_quantity(const Model& model, const std::string& text, const std::string& option);
std::vector<RequestedQuantity> requested_quantities(const Model& model, const std::vector<std::string>& texts,
                                                    const std::string& option);

/// The columns in which tables show a state: all states, then the quantities asked for.
class StateColumns {
public:
    StateColumns(const Model& model, const std::vector<RequestedQuantity>& quantities);
    /// @param suffix behind every name
    void declare(std::vector<Table::Column>& columns, const std::string& suffix = {}) const;
    void add(Table& table, std::span<const double> state);

private:
    std::vector<Table::Column> columns_;
    QuantityEvaluator evaluate_;
};

} // namespace graze
