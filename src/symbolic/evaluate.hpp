#pragma once

#include "graze/symbolic/expression.hpp"
#include "symbolic/function_table.hpp"

#include <cmath>
#include <limits>

namespace graze {

/// Returns the value of one operation in double precision. Constant folding and evaluation both use this function, so
/// that folding changes no result. Functions of one operand ignore `right`.
inline double evaluate_operation(Operation operation, double left, double right) {
    switch (operation) {
    case Operation::number:
    case Operation::symbol:
    case Operation::lookup: // see Function
        break;
    case Operation::add:
        return left + right;
    case Operation::subtract:
        return left - right;
    case Operation::multiply:
        return left * right;
    case Operation::divide:
        return left / right;
    case Operation::power:
        return std::pow(left, right);
    case Operation::negate:
        return -left;
#define GRAZE_ROW(name, recurrence, slope)                                                                             \
    case Operation::name:                                                                                              \
        return std::name(left);
        GRAZE_FUNCTIONS(GRAZE_ROW)
#undef GRAZE_ROW
    }
    return std::numeric_limits<double>::quiet_NaN();
}

/// Returns the derivative of a function at a, where its value is y.
inline double function_slope(Operation function, double a, double y) {
#define GRAZE_ROW(name, recurrence, slope) using std::name;
    GRAZE_FUNCTIONS(GRAZE_ROW) // functions of numbers, not those of Expression
#undef GRAZE_ROW
    const auto square = [](double x) { return x * x; };
    const auto one_minus_square = [](double x) { return (1 - x) * (1 + x); };
    switch (function) {
#define GRAZE_ROW(name, recurrence, slope)                                                                             \
    case Operation::name:                                                                                              \
        return slope;
        GRAZE_FUNCTIONS(GRAZE_ROW)
#undef GRAZE_ROW
    default:
        return std::numeric_limits<double>::quiet_NaN();
    }
}

} // namespace graze
