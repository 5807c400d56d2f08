#pragma once

#include "graze/symbolic/expression.hpp"

// All functions of one argument, in the order of Operation: row(name, recurrence, slope). Everything that depends on
// the list of functions is generated from this table: names, values, derivatives, kernels.
//
// name         of the function in expressions, in the C library, in Operation and in SeriesOperation
// recurrence   how the coefficients of its series follow from those of its argument: an enumerator of Recurrence, see
//              tape/recurrence.hpp
// slope        its derivative at a, where its value is y. It is compiled for numbers and for expressions alike: both
//              have operators, these functions, square(x), and one_minus_square(x). Ends of a domain are factors of
//              their own, as in (1 - a)(1 + a), since 1 - a^2 cancels near them.
//
// This file declares no functions, since it is included by code for several instruction sets.
// clang-format off
#define GRAZE_FUNCTIONS(row) \
    row(sqrt, own, 1 / (2 * y)) \
    row(exp, product, y) \
    row(log, quotient, 1 / a) \
    row(sin, product, cos(a)) \
    row(cos, minus_product, -sin(a)) \
    row(tan, product, 1 + square(y)) \
    row(asin, quotient, 1 / sqrt((1 - a) * (1 + a))) \
    row(acos, minus_quotient, -1 / sqrt((1 - a) * (1 + a))) \
    row(atan, quotient, 1 / (1 + square(a))) \
    row(sinh, product, cosh(a)) \
    row(cosh, product, sinh(a)) \
    row(tanh, product, one_minus_square(y)) \
    row(erf, product, two_over_root_pi * exp(-square(a)))
// clang-format on

namespace graze {

inline constexpr double two_over_root_pi = 1.1283791670955126;

#define GRAZE_ROW(name, recurrence, slope) Operation::name,
inline constexpr Operation all_functions[] = {GRAZE_FUNCTIONS(GRAZE_ROW)};
#undef GRAZE_ROW
inline constexpr int function_count = sizeof all_functions / sizeof all_functions[0];
inline constexpr Operation last_function = all_functions[function_count - 1];

} // namespace graze
