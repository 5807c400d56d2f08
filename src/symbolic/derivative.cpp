#include "symbolic/derivative.hpp"

#include "graze/base/input_error.hpp"
#include "symbolic/function_table.hpp"

namespace graze {

namespace {

Expression square(const Expression& x) {
    return pow(x, 2);
}
Expression one_minus_square(const Expression& x) {
    return 1 - square(x);
}

/// Returns the sum; an empty expression stands for zero.
Expression sum_of(const Expression& a, const Expression& b) {
    if (a.empty())
        return b;
    return b.empty() ? a : a + b;
}

/// Returns the derivative of base^exponent. For a constant exponent no logarithm appears, so that powers of negative
/// bases have derivatives too.
Expression derivative_of_power(const Expression& value, const Expression& base, const Expression& exponent,
                               const Expression& base_rate, const Expression& exponent_rate) {
    Expression result;
    if (!base_rate.empty())
        result = exponent * pow(base, exponent - 1) * base_rate;
    if (!exponent_rate.empty())
        result = sum_of(result, value * log(base) * exponent_rate);
    return result;
}

} // namespace

Expression slope_of(Operation operation, const Expression& y, const Expression& a) {
    switch (operation) {
    case Operation::negate:
        return a.graph()->number(-1);
    case Operation::lookup: {
        const auto [table, derivative] = Graph::lookup_of(y.node());
        return a.graph()->look_up(table, derivative + 1, a);
    }
#define GRAZE_ROW(name, recurrence, slope)                                                                             \
    case Operation::name:                                                                                              \
        return slope;
        GRAZE_FUNCTIONS(GRAZE_ROW)
#undef GRAZE_ROW
    default:
        throw InputError("an operation of one operand was expected", "");
    }
}

Expression derivative_of(Operation operation, const Expression& value, const Expression& left, const Expression& right,
                         const Expression& left_rate, const Expression& right_rate) {
    switch (operation) {
    case Operation::add:
        return sum_of(left_rate, right_rate);
    case Operation::subtract:
        return sum_of(left_rate, right_rate.empty() ? right_rate : -right_rate);
    case Operation::multiply:
        return sum_of(left_rate.empty() ? left_rate : left_rate * right,
                      right_rate.empty() ? right_rate : left * right_rate);
    case Operation::divide:
        return sum_of(left_rate, right_rate.empty() ? right_rate : -(value * right_rate)) / right;
    case Operation::power:
        return derivative_of_power(value, left, right, left_rate, right_rate);
    default:
        break;
    }
    return slope_of(operation, value, left) * left_rate;
}

} // namespace graze
