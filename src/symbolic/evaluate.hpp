#pragma once

#include "graze/symbolic/expression.hpp"

#include <cmath>
#include <limits>

namespace graze {

/// The value of one operation in double precision. Constants are folded and functions evaluated by this code
/// alone, so that folding changes no result. Functions of one operand ignore the second.
inline double evaluate_operation(Operation operation, double left, double right) {
    switch (operation) {
    case Operation::number:
    case Operation::symbol:
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
    case Operation::sqrt:
        return std::sqrt(left);
    case Operation::exp:
        return std::exp(left);
    case Operation::log:
        return std::log(left);
    case Operation::sin:
        return std::sin(left);
    case Operation::cos:
        return std::cos(left);
    case Operation::tan:
        return std::tan(left);
    case Operation::asin:
        return std::asin(left);
    case Operation::acos:
        return std::acos(left);
    case Operation::atan:
        return std::atan(left);
    case Operation::sinh:
        return std::sinh(left);
    case Operation::cosh:
        return std::cosh(left);
    case Operation::tanh:
        return std::tanh(left);
    }
    return std::numeric_limits<double>::quiet_NaN();
}

} // namespace graze
