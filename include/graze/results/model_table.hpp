#pragma once

#include "graze/model/model.hpp"
#include "graze/results/table.hpp"

#include <vector>

namespace graze {

/// Everything in a model that has a name, one row each: item, name, value, unit, text.
Table model_table(const Model& model);

/// Values of all parameters, the dependent ones too, in the order of the model.
std::vector<double> all_parameter_values(const Model& model);

} // namespace graze
