#pragma once

#include "graze/model/model.hpp"
#include "graze/results/table.hpp"

#include <string>
#include <vector>

namespace graze {

/// A table with one row for every named item of a model: item, name, value, unit, text.
Table model_table(const Model& model);

/// The same for reading: aligned rows under headings such as "2 modes", after an empty line each.
std::string model_listing(const Model& model);

/// Values of all parameters, including dependent ones, in the order of the model.
std::vector<double> all_parameter_values(const Model& model);

} // namespace graze
