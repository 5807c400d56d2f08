#include "symbolic/interval_operation.hpp"

#include "symbolic/evaluate.hpp"
#include "symbolic/rounded_outwards.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace graze {

namespace {

constexpr double boundless = std::numeric_limits<double>::infinity();
/// Units in the last place by which results of the C library are widened. The GNU C library documents errors of at most
/// 2 for these functions (its manual, "Known Maximum Errors in Math Functions").
constexpr int library_error = 4;

/// Functions that are 0 at a number, at 0 or 1, are so exactly.
bool is_exact_zero(double argument, double value) {
    return value == 0 && (argument == 0 || argument == 1);
}

double value_below(Operation operation, double argument) {
    const double value = evaluate_operation(operation, argument, 0);
    return is_exact_zero(argument, value) ? value : next_below(value, library_error);
}

double value_above(Operation operation, double argument) {
    const double value = evaluate_operation(operation, argument, 0);
    return is_exact_zero(argument, value) ? value : next_above(value, library_error);
}

/// A function that rises where it is defined. @param values all that it can give
Interval rising(Operation operation, const Interval& a, const Interval& domain, const Interval& values) {
    const Interval inside = intersection(a, domain);
    if (inside.empty())
        return inside;
    return {std::max(values.lower, value_below(operation, inside.lower)),
            std::min(values.upper, value_above(operation, inside.upper)), a.continuous && domain.contains(a)};
}

Interval square_root(const Interval& a) {
    const Interval inside = intersection(a, {0, boundless});
    if (inside.empty())
        return inside;
    // The square root is rounded to the nearest number.
    const double least = std::sqrt(inside.lower), largest = std::sqrt(inside.upper);
    return {least == 0 ? 0 : next_below(least), largest == 0 ? 0 : next_above(largest), a.continuous && a.lower >= 0};
}

Interval hyperbolic_cosine(const Interval& a) {
    const double nearest = a.contains(0) ? 0 : std::min(std::abs(a.lower), std::abs(a.upper));
    return {std::max(1.0, value_below(Operation::cosh, nearest)), value_above(Operation::cosh, a.magnitude()),
            a.continuous};
}

/// The interval in units of a quarter turn, widened by the rounding of that division. Beyond 2^52 units it contains a
/// whole turn.
Interval quarter_turns(const Interval& a) {
    const auto turns = [](double angle) { return angle * (2 / std::numbers::pi); };
    const auto error = [](double value) { return 4 * std::numeric_limits<double>::epsilon() * std::abs(value); };
    const double first = turns(a.lower), last = turns(a.upper);
    if (!std::isfinite(first) || !std::isfinite(last) || error(first) > 1 || error(last) > 1)
        return {-4, 4};
    return {first - error(first), last + error(last)};
}

/// True if place + period k lies in the interval for a whole number k.
bool meets(const Interval& a, double place, double period) {
    return place + period * std::ceil((a.lower - place) / period) <= a.upper;
}

/// Sine and cosine. @param crest the place of a maximum in quarter turns
Interval wave(Operation operation, const Interval& a, double crest) {
    const Interval turns = quarter_turns(a);
    Interval result{-1, 1, a.continuous};
    if (!a.bounded())
        return result;
    if (!meets(turns, crest + 2, 4))
        result.lower = std::max(-1.0, std::min(value_below(operation, a.lower), value_below(operation, a.upper)));
    if (!meets(turns, crest, 4))
        result.upper = std::min(1.0, std::max(value_above(operation, a.lower), value_above(operation, a.upper)));
    return result;
}

Interval tangent(const Interval& a) {
    if (!a.bounded() || meets(quarter_turns(a), 1, 2)) {
        Interval result = Interval::entire();
        result.continuous = false;
        return result;
    }
    return {value_below(Operation::tan, a.lower), value_above(Operation::tan, a.upper), a.continuous};
}

Interval logarithm(const Interval& a) {
    if (a.upper <= 0)
        return Interval::none();
    Interval result = rising(Operation::log, a, {0, boundless}, Interval::entire());
    result.continuous = a.continuous && a.lower > 0;
    return result;
}

Interval square(const Interval& a) {
    if (a.empty())
        return a;
    const double nearest = a.contains(0) ? 0 : std::min(std::abs(a.lower), std::abs(a.upper)), farthest = a.magnitude();
    const Interval least = Interval::point(nearest) * Interval::point(nearest),
                   largest = Interval::point(farthest) * Interval::point(farthest);
    return {least.lower, largest.upper, a.continuous};
}

/// Values of powers, widened; powers of 0 and infinity are exact.
double power_below(double base, double exponent) {
    const double value = std::pow(base, exponent);
    return base == 0 || (value == 0 && std::isinf(base)) ? value : std::max(0.0, next_below(value, library_error));
}

double power_above(double base, double exponent) {
    const double value = std::pow(base, exponent);
    return base == 0 ? value : next_above(value, library_error);
}

/// Powers of bases that are not negative. They are monotonic in the base and in the exponent.
Interval positive_power(const Interval& base, const Interval& exponent) {
    Interval result = Interval::none();
    if (base.upper == 0 && exponent.upper < 0)
        return result;
    for (const double x : {base.lower, base.upper})
        for (const double y : {exponent.lower, exponent.upper})
            result = hull(result, {power_below(x, y), power_above(x, y)});
    const bool defined = base.lower > 0 || exponent.lower > 0;
    result.continuous = base.continuous && exponent.continuous && defined;
    return result;
}

Interval whole_power(const Interval& base, double exponent) {
    if (exponent < 0)
        return Interval::point(1) / whole_power(base, -exponent);
    if (exponent == 0)
        return {1, 1, base.continuous};
    if (exponent == 2)
        return square(base);
    const Interval power = Interval::point(exponent);
    const bool odd = std::fmod(exponent, 2) != 0;
    if (base.lower >= 0)
        return positive_power(base, power);
    if (base.upper <= 0) {
        const Interval size = positive_power(-base, power);
        return odd ? -size : size;
    }
    const Interval negative = positive_power({0, -base.lower, base.continuous}, power);
    const Interval positive = positive_power({0, base.upper, base.continuous}, power);
    return odd ? hull(-negative, positive) : hull(negative, positive);
}

Interval power(const Interval& base, const Interval& exponent) {
    if (exponent.is_point(std::trunc(exponent.lower)) && std::isfinite(exponent.lower)) {
        Interval result = whole_power(base, exponent.lower);
        result.continuous = result.continuous && exponent.continuous;
        return result;
    }
    const Interval inside = intersection(base, {0, boundless});
    Interval result = inside.empty() ? inside : positive_power(inside, exponent);
    if (base.lower < 0) {
        // Negative bases have powers with whole exponents only, of either sign.
        if (std::ceil(exponent.lower) <= exponent.upper) {
            const double largest = positive_power({0, -base.lower}, exponent).upper;
            result = hull(result, {-largest, largest});
        }
        result.continuous = false;
    }
    return result;
}

/// Returns the part of an interval whose absolute values lie in `size`.
Interval with_size(const Interval& a, const Interval& size) {
    const Interval positive = intersection(size, {0, boundless});
    return positive.empty() ? positive : hull(intersection(a, positive), intersection(a, -positive));
}

/// Returns y^(1/exponent) for the part of y that is not negative. The error of 1/exponent is multiplied by the
/// logarithm of the result, which is at most 745.
Interval positive_root(const Interval& y, double exponent) {
    constexpr double more = 1 + 1e-12;
    const Interval inside = intersection(y, {0, boundless});
    if (inside.empty())
        return inside;
    const Interval root = positive_power(inside, Interval::point(1 / exponent));
    return {next_below(root.lower / more), next_above(root.upper * more)};
}

void narrow_base(const Interval& result, Interval& base, double exponent) {
    if (exponent == 0)
        return;
    if (exponent != std::trunc(exponent)) {
        base = intersection(base, intersection({0, boundless}, positive_root(result, exponent)));
        return;
    }
    if (exponent < 0) {
        narrow_base(intersect_quotient(Interval::entire(), Interval::point(1), result), base, -exponent);
        return;
    }
    if (std::fmod(exponent, 2) == 0) {
        base = with_size(base, exponent == 2 ? square_root(result) : positive_root(result, exponent));
        return;
    }
    const Interval positive = positive_root(result, exponent), negative = positive_root(-result, exponent);
    base = intersection(base, hull(positive, -negative));
}

/// An angle beside a pole, where the tangent is larger than any value wanted.
void narrow_angle(const Interval& result, Interval& angle) {
    if (angle.width() < 3 && meets(quarter_turns(angle), 1, 2) &&
        value_below(Operation::tan, angle.lower) > result.upper &&
        value_above(Operation::tan, angle.upper) < result.lower)
        angle = Interval::none();
}

} // namespace

Interval enclose_operation(Operation operation, const Interval& left, const Interval& right, bool same) {
    const Interval all = Interval::entire();
    if (left.empty() || right.empty())
        return Interval::none();
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
        return same ? square(left) : left * right;
    case Operation::divide:
        return left / right;
    case Operation::power:
        return power(left, right);
    case Operation::negate:
        return -left;
    case Operation::sqrt:
        return square_root(left);
    case Operation::exp:
        return rising(operation, left, all, {0, boundless});
    case Operation::log:
        return logarithm(left);
    case Operation::sin:
        return wave(operation, left, 1);
    case Operation::cos:
        return wave(operation, left, 0);
    case Operation::tan:
        return tangent(left);
    case Operation::asin:
        return rising(operation, left, {-1, 1}, all);
    case Operation::acos: {
        const Interval inside = intersection(left, {-1, 1});
        if (inside.empty())
            return inside;
        return {value_below(operation, inside.upper), value_above(operation, inside.lower),
                left.continuous && Interval{-1, 1}.contains(left)};
    }
    case Operation::atan:
    case Operation::sinh:
        return rising(operation, left, all, all);
    case Operation::cosh:
        return hyperbolic_cosine(left);
    case Operation::tanh:
    case Operation::erf:
        return rising(operation, left, all, {-1, 1});
    }
    return all;
}

void narrow_operands(Operation operation, const Interval& result, Interval& left, Interval& right, bool same) {
    switch (operation) {
    case Operation::add:
        left = intersection(left, result - right);
        right = intersection(right, result - left);
        return;
    case Operation::subtract:
        left = intersection(left, result + right);
        right = intersection(right, left - result);
        return;
    case Operation::multiply:
        if (same) {
            left = with_size(left, square_root(result));
            return;
        }
        left = intersect_quotient(left, result, right);
        right = intersect_quotient(right, result, left);
        return;
    case Operation::divide:
        left = intersection(left, result * right);
        right = intersect_quotient(right, left, result);
        return;
    case Operation::power:
        if (right.is_point(right.lower) && std::isfinite(right.lower))
            narrow_base(result, left, right.lower);
        return;
    case Operation::negate:
        left = intersection(left, -result);
        return;
    case Operation::sqrt:
        left = intersection(left, square(intersection(result, {0, boundless})));
        return;
    case Operation::exp:
        left = intersection(left, logarithm(result));
        return;
    case Operation::log:
        left = intersection(left, rising(Operation::exp, result, Interval::entire(), {0, boundless}));
        return;
    case Operation::tan:
        narrow_angle(result, left);
        return;
    default:
        return;
    }
}

} // namespace graze
