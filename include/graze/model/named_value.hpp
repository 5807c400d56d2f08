#pragma once

#include "graze/base/input_error.hpp"
#include "graze/model/model.hpp"

#include <string>
#include <string_view>

namespace graze {

/// Something of a state that a user asks for: a state, quantity, parameter or definition by its name, or an expression.
struct NamedValue {
    std::string name, unit, text;
    Expression value; ///< in states and independent parameters, of a graph of its own
};

/// @param place of the text, for messages
/// @throws InputError with the place when it is no expression
NamedValue named_value(const Model& model, const std::string& text, const Place& place);

/// Value of a number or expression in the model's parameters, at their present values.
/// @throws InputError when it is no expression or not finite
double value_of_text(const Model& model, std::string_view text, const Place& place);

} // namespace graze
