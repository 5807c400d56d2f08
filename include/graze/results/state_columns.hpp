#pragma once

#include "graze/results/quantity_evaluator.hpp"
#include "graze/results/table.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// The columns in which tables show a state: all states, then the quantities asked for.
class StateColumns {
public:
    StateColumns(const Model& model, const std::vector<NamedValue>& quantities);
    /// @param suffix behind every name
    void declare(std::vector<Table::Column>& columns, const std::string& suffix = {}) const;
    void add(Table& table, std::span<const double> state);

private:
    std::vector<Table::Column> columns_;
    QuantityEvaluator evaluate_;
};

} // namespace graze
