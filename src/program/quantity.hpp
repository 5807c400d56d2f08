#pragma once

#include "graze/model/named_value.hpp"

#include <string>
#include <vector>

namespace graze {

/// An expression in states and parameters whose values the user asked for.
using RequestedQuantity = NamedValue;

/// Parses a quantity's name or an expression. @param option for messages
/// @throws InputError with the place when it is no expression
RequestedQuantity requested_quantity(const Model& model, const std::string& text, const std::string& option);
std::vector<RequestedQuantity> requested_quantities(const Model& model, const std::vector<std::string>& texts,
                                                    const std::string& option);

} // namespace graze
