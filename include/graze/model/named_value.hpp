#pragma once

#include "graze/base/input_error.hpp"
#include "graze/model/model.hpp"

#include <string>
#include <string_view>

namespace graze {

/// A value that a user asks for: a state, quantity, parameter or definition by name, or an expression.
struct NamedValue {
    std::string name, unit, text;
    Expression value; ///< in states and independent parameters; belongs to its own graph
};

/// Returns the named value, or the expression, given by `text`.
/// @throws InputError with the place when the text is neither a name nor an expression. @param place of the text
NamedValue named_value(const Model& model, const std::string& text, const Place& place);

/// Whether two texts are the same expression: sums and products are printed in an order that depends on what their
/// model has read before. @return false also for a text that is no expression
bool are_same_expression(const Model& model, const std::string& one, const std::string& other);

/// Returns the value of a number, or of an expression in parameters, at the model's present values.
/// @throws InputError when the text is not an expression, or its value is not finite
double value_of_text(const Model& model, std::string_view text, const Place& place);

// The same for texts that are given as values of an option or argument, which messages name before the text.

NamedValue requested_quantity(const Model& model, const std::string& text, const std::string& option);
double value_of(const Model& model, std::string_view text, const std::string& option);

} // namespace graze
