#pragma once

#include "graze/symbolic/expression.hpp"

namespace graze {

/// d/da of an operation of one operand a, in terms of it and of the operation's value y.
/// @throws std::invalid_argument for operations of two operands, or none
Expression slope_of(Operation operation, const Expression& y, const Expression& a);

} // namespace graze
