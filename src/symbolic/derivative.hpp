#pragma once

#include "graze/symbolic/expression.hpp"

namespace graze {

/// d/da of an operation of one operand a, in terms of it and of the operation's value y.
/// @throws InputError for operations of two operands, or none
Expression slope_of(Operation operation, const Expression& y, const Expression& a);

/// Derivative of an operation from those of its operands, which are empty where they are zero (but not all).
/// @param right of an operation of one operand, anything
Expression derivative_of(Operation operation, const Expression& value, const Expression& left, const Expression& right,
                         const Expression& left_rate, const Expression& right_rate);

} // namespace graze
