#pragma once

#include "graze/model/named_value.hpp"

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

} // namespace graze
