#include "symbolic/simplify.hpp"

#include "symbolic/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace graze {

namespace {

/// Sums of constants are merged only if that is exact: in (x + 1e16) + 0.3 with x near -1e16, the rounding error of a
/// merged constant would dominate the result.
std::optional<double> exact_sum(double a, double b) {
    const double sum = a + b;
    const double b_share = sum - a;
    const double error = (a - (sum - b_share)) + (b - b_share);
    if (!std::isfinite(sum) || error != 0)
        return std::nullopt;
    return sum;
}

/// A rounded factor changes a product by round-off only, unless it leaves the range of normal numbers.
std::optional<double> safe_product(double a, double b) {
    const double product = a * b;
    if (!std::isnormal(product))
        return std::nullopt;
    return product;
}

std::optional<double> exact_quotient(double a, double b) {
    const double quotient = a / b;
    if (!std::isnormal(quotient) || std::fma(quotient, b, -a) != 0)
        return std::nullopt;
    return quotient;
}

} // namespace

NodeIndex Simplifier::number(double value) {
    // Adding 0 turns -0 into 0.
    return graph_.intern({Operation::number, 0, 0, value + 0.0});
}

NodeIndex Simplifier::intern(Operation operation, NodeIndex left, NodeIndex right) {
    return graph_.intern({operation, left, right, 0});
}

NodeIndex Simplifier::function(Operation operation, NodeIndex operand) {
    if (graph_.is_undefined(operand))
        return intern(operation, operand);
    if (operation == Operation::negate) {
        Signed value = split(operand);
        value.negative = !value.negative;
        return with_sign(value);
    }
    if (is_number(operand)) {
        const double value = evaluate_operation(operation, node(operand).value, 0);
        if (std::isfinite(value))
            return number(value);
    }
    return intern(operation, operand);
}

NodeIndex Simplifier::arithmetic(Operation operation, NodeIndex left, NodeIndex right) {
    if (graph_.is_undefined(left) || graph_.is_undefined(right))
        return intern(operation, left, right);
    if (is_number(left) && is_number(right)) {
        const double value = evaluate_operation(operation, node(left).value, node(right).value);
        return std::isfinite(value) ? number(value) : intern(operation, left, right);
    }
    if (operation == Operation::power)
        return power(left, right);
    const Signed one = split(left);
    Signed other = split(right);
    if (operation == Operation::add || operation == Operation::subtract) {
        if (operation == Operation::subtract)
            other.negative = !other.negative;
        return sum(one, other);
    }
    const NodeIndex magnitude = operation == Operation::multiply ? product(one.magnitude, other.magnitude)
                                                                 : quotient(one.magnitude, other.magnitude);
    return one.negative != other.negative ? negated(magnitude) : magnitude;
}

Simplifier::Signed Simplifier::split(NodeIndex index) {
    const Node given = node(index); // a copy: interning moves the nodes
    switch (given.operation) {
    case Operation::number:
        return given.value < 0 ? Signed{true, number(-given.value)} : Signed{false, index};
    case Operation::negate:
        return {true, given.left};
    case Operation::multiply:
    case Operation::divide:
        if (is_number(given.left) && node(given.left).value < 0)
            return {true, intern(given.operation, number(-node(given.left).value), given.right)};
        return {false, index};
    default:
        return {false, index};
    }
}

NodeIndex Simplifier::negated(NodeIndex magnitude) {
    const Node given = node(magnitude);
    switch (given.operation) {
    case Operation::number:
        return number(-given.value);
    case Operation::negate:
        return given.left;
    case Operation::subtract:
        return intern(Operation::subtract, given.right, given.left);
    case Operation::multiply:
    case Operation::divide:
        if (is_number(given.left))
            return intern(given.operation, number(-node(given.left).value), given.right);
        break;
    default:
        break;
    }
    return intern(Operation::negate, magnitude);
}

NodeIndex Simplifier::sum(Signed left, Signed right) {
    if (is_number(left.magnitude))
        std::swap(left, right);
    if (is_number(right.magnitude)) {
        const double constant = node(right.magnitude).value;
        const NodeIndex magnitude =
            sum_with_constant(left.magnitude, left.negative == right.negative ? constant : -constant);
        return left.negative ? negated(magnitude) : magnitude;
    }
    if (left.negative != right.negative) {
        if (left.magnitude == right.magnitude)
            return number(0);
        const auto [positive, negative] = left.negative ? std::pair(right, left) : std::pair(left, right);
        return intern(Operation::subtract, positive.magnitude, negative.magnitude);
    }
    const NodeIndex magnitude = left.magnitude == right.magnitude
                                    ? scaled(2, left.magnitude)
                                    : intern(Operation::add, std::min(left.magnitude, right.magnitude),
                                             std::max(left.magnitude, right.magnitude));
    return left.negative ? negated(magnitude) : magnitude;
}

/// The result may be negative: the caller applies the sign by `negated`, which cancels a double negation.
NodeIndex Simplifier::sum_with_constant(NodeIndex magnitude, double constant) {
    bool flipped = false; // the sum wanted is then -(magnitude + constant)
    while (constant != 0) {
        const Node given = node(magnitude);
        std::optional<double> merged;
        if (has_number_on_right(magnitude, Operation::add)) {
            merged = exact_sum(node(given.right).value, constant);
            magnitude = merged ? given.left : magnitude;
        } else if (has_number_on_right(magnitude, Operation::subtract)) {
            merged = exact_sum(-node(given.right).value, constant);
            magnitude = merged ? given.left : magnitude;
        } else if (has_number_on_left(magnitude, Operation::subtract)) {
            merged = exact_sum(node(given.left).value, constant);
            if (merged) {
                magnitude = given.right;
                flipped = !flipped;
                merged = -*merged;
            }
        }
        if (!merged)
            break;
        constant = *merged;
    }
    NodeIndex result = magnitude;
    if (constant > 0)
        result = intern(Operation::add, magnitude, number(constant));
    else if (constant < 0)
        result = intern(Operation::subtract, magnitude, number(-constant));
    return flipped ? negated(result) : result;
}

NodeIndex Simplifier::product(NodeIndex left, NodeIndex right) {
    if (is_number(right))
        std::swap(left, right);
    if (is_number(left))
        return scaled(node(left).value, right);
    if (left > right)
        std::swap(left, right);
    if (has_number_on_left(right, Operation::divide) && is_number(node(right).left, 1))
        return quotient(left, node(right).right);
    if (has_number_on_left(left, Operation::divide) && is_number(node(left).left, 1))
        return quotient(right, node(left).right);
    return intern(Operation::multiply, left, right);
}

NodeIndex Simplifier::scaled(double factor, NodeIndex magnitude) {
    if (factor == 0)
        return number(0);
    while (has_number_on_left(magnitude, Operation::multiply)) {
        const std::optional<double> merged = safe_product(factor, node(node(magnitude).left).value);
        if (!merged)
            break;
        factor = *merged;
        magnitude = node(magnitude).right;
    }
    if (factor == 1)
        return magnitude;
    if (has_number_on_left(magnitude, Operation::divide)) {
        const NodeIndex divisor = node(magnitude).right;
        if (const std::optional<double> merged = safe_product(factor, node(node(magnitude).left).value))
            return intern(Operation::divide, number(*merged), divisor);
    }
    return intern(Operation::multiply, number(factor), magnitude);
}

NodeIndex Simplifier::quotient(NodeIndex left, NodeIndex right) {
    if (is_number(right, 1) || is_number(left, 0))
        return left;
    if (is_number(right)) {
        const double divisor = node(right).value;
        for (const Operation operation : {Operation::multiply, Operation::divide}) {
            if (!has_number_on_left(left, operation))
                continue;
            const NodeIndex rest = node(left).right;
            const std::optional<double> merged = exact_quotient(node(node(left).left).value, divisor);
            if (merged && operation == Operation::multiply)
                return scaled(*merged, rest);
            if (merged)
                return intern(Operation::divide, number(*merged), rest);
        }
    }
    return intern(Operation::divide, left, right);
}

NodeIndex Simplifier::power(NodeIndex base, NodeIndex exponent) {
    if (is_number(exponent, 0) || is_number(base, 1))
        return number(1);
    if (is_number(exponent, 1))
        return base;
    return intern(Operation::power, base, exponent);
}

} // namespace graze
