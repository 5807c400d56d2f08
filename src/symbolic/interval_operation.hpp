#pragma once

#include "graze/symbolic/expression.hpp"
#include "graze/symbolic/interval.hpp"

namespace graze {

/// Encloses the values of one operation. Functions of one operand ignore `right`.
/// @param same both operands are one and the same quantity, so that x*x is not negative
Interval enclose_operation(Operation operation, const Interval& left, const Interval& right, bool same);

/// Shrinks the operands to intervals that contain all values for which the operation gives a value in `result`. The
/// operands of some functions stay as they are.
/// @param same both operands are one and the same quantity, which is `left`
void narrow_operands(Operation operation, const Interval& result, Interval& left, Interval& right, bool same);

} // namespace graze
