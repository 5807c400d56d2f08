#pragma once

#include "graze/model/named_value.hpp"
#include "graze/results/table.hpp"
#include "graze/symbolic/function.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Evaluates quantities at states, at first with the parameter values that the model has at construction.
class QuantityEvaluator {
public:
    QuantityEvaluator(const Model& model, const std::vector<NamedValue>& quantities);
    /// Values of the quantities at a state; valid until the next call.
    std::span<const double> operator()(std::span<const double> state);
    /// Other values of the independent parameters. @throws InputError for a wrong number of them
    void set_parameters(std::span<const double> values);

private:
    Function function_;
    std::size_t states_;
    std::vector<double> inputs_, values_, work_;
};

/// The columns of a table that show a state: one for each component, then one for each requested quantity.
class StateColumns {
public:
    StateColumns(const Model& model, const std::vector<NamedValue>& quantities);
    /// A list of columns followed by these. @param suffix appended to the name of each of these
    std::vector<Table::Column> after(std::vector<Table::Column> columns, const std::string& suffix = {}) const;
    void add(Table& table, std::span<const double> state);
    /// See QuantityEvaluator.
    void set_parameters(std::span<const double> values) { evaluate_.set_parameters(values); }

private:
    std::vector<Table::Column> columns_;
    QuantityEvaluator evaluate_;
};

} // namespace graze
