#pragma once

#include "base/special_numbers.hpp"
#include "symbolic/evaluate.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

/// Bounds the distance of the computed value of one operation from the true one, to first order: the propagated errors
/// of the operands plus its own rounding. At the end of an operation's domain, where the slope is unbounded, the square
/// root of the error is used. Functions of one operand ignore the second.
/// @param value the computed value
inline double operation_error(Operation operation, double value, double left, double left_error, double right,
                              double right_error) {
    const double rounding = epsilon * std::abs(value);
    const auto steep = [&](double slope) {
        return left_error > 0 ? std::min(std::abs(slope) * left_error, 2 * std::sqrt(left_error)) : 0;
    };
    switch (operation) {
    case Operation::number:
    case Operation::symbol:
        return 0;
    case Operation::add:
    case Operation::subtract:
        return left_error + right_error + rounding;
    case Operation::multiply:
        return std::abs(right) * left_error + std::abs(left) * right_error + rounding;
    case Operation::divide:
        return (left_error + std::abs(value) * right_error) / std::abs(right) + rounding;
    case Operation::power: {
        const double by_base = left_error > 0 ? std::abs(right * std::pow(left, right - 1)) * left_error : 0;
        const double by_exponent = right_error > 0 && left > 0 ? std::abs(value * std::log(left)) * right_error : 0;
        return (std::isfinite(by_base) ? by_base : std::pow(left_error, std::abs(right))) + by_exponent + rounding;
    }
    case Operation::negate:
        return left_error;
    case Operation::sqrt:
        return steep(0.5 / value) + rounding;
    case Operation::exp:
        return std::abs(value) * left_error + rounding;
    case Operation::log:
        return left_error / std::abs(left) + rounding;
    case Operation::sin:
    case Operation::cos:
        return std::sqrt(std::max(0.0, 1 - value * value)) * left_error + left_error * left_error + rounding;
    case Operation::tan:
        return (1 + value * value) * left_error + rounding;
    case Operation::asin:
    case Operation::acos:
        return steep(1 / std::sqrt(std::max(0.0, (1 - left) * (1 + left)))) + rounding;
    case Operation::atan:
        return left_error / (1 + left * left) + rounding;
    case Operation::sinh:
        return std::sqrt(1 + value * value) * left_error + rounding;
    case Operation::cosh:
        return std::sqrt(std::max(0.0, value * value - 1)) * left_error + left_error * left_error + rounding;
    case Operation::tanh:
        return std::max(0.0, 1 - value * value) * left_error + left_error * left_error + rounding;
    default: // the square covers places where the slope is zero
        return std::abs(function_slope(operation, left, value)) * left_error + left_error * left_error + rounding;
    }
}

} // namespace graze
