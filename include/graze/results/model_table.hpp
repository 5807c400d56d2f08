#pragma once

#include "graze/model/model.hpp"
#include "graze/results/table.hpp"

#include <vector>

namespace graze {

/// A table with one row for every named item of a model: item, name, value, unit, text.
Table model_table(const Model& model);

/// Values of all parameters, including dependent ones, in the order of the model.
std::vector<double> all_parameter_values(const Model& model);

} // namespace graze
