#pragma once

#include "graze/results/quantity_evaluator.hpp"
#include "graze/results/table.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// The columns of a table that show a state: one for each component, then one for each requested quantity.
class StateColumns {
public:
    StateColumns(const Model& model, const std::vector<NamedValue>& quantities);
    /// Adds the columns to a list of them. @param suffix appended to every name
    void declare(std::vector<Table::Column>& columns, const std::string& suffix = {}) const;
    void add(Table& table, std::span<const double> state);

private:
    std::vector<Table::Column> columns_;
    QuantityEvaluator evaluate_;
};

} // namespace graze
