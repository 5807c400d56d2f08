#pragma once

#include "graze/model/model.hpp"
#include "program/table.hpp"
#include "program/wrapped_text.hpp"

#include <string>

namespace graze {

/// Everything in a model that has a name, one row each: item, name, value, unit, text.
Table describe_in_table(const Model& model);
/// The same for people. @param width letters in a line of its text
std::string describe(const Model& model, std::size_t width = common_line_width);

/// Values of all parameters, the dependent ones too, in the order of the model.
std::vector<double> all_parameter_values(const Model& model);

} // namespace graze
