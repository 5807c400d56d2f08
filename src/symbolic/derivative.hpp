#pragma once

#include "graze/symbolic/expression.hpp"

namespace graze {

/// Returns dy/da for an operation y of one operand a, in terms of a and y.
/// @throws InputError unless the operation has one operand
Expression slope_of(Operation operation, const Expression& y, const Expression& a);

/// Returns the derivative of an operation, given those of its operands; an empty one stands for zero (not both may be).
/// @param right ignored if the operation has one operand
Expression derivative_of(Operation operation, const Expression& value, const Expression& left, const Expression& right,
                         const Expression& left_rate, const Expression& right_rate);

} // namespace graze
