#include "graze/symbolic/interval.hpp"

#include "symbolic/rounded_outwards.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace graze {

namespace {

constexpr double tiniest = std::numeric_limits<double>::denorm_min();

/// Returns the interval between the least and the largest of rounded values. Exact zeros are not moved: signs would be
/// lost with them.
Interval rounded_hull(std::initializer_list<double> values, bool continuous) {
    const double least = std::min(values), largest = std::max(values);
    return {least == 0 ? 0 : next_below(least), largest == 0 ? 0 : next_above(largest), continuous};
}

/// A result that is not zero but too small for a number becomes the smallest number of its sign, which `rounded_hull`
/// moves to its sides.
double not_lost(double rounded) {
    return rounded == 0 ? std::copysign(tiniest, rounded) : rounded;
}

/// Products of ends; an infinite end is not in the interval, so 0 times it is 0.
double end_product(double a, double b) {
    return a == 0 || b == 0 ? 0 : not_lost(a * b);
}

double end_quotient(double a, double b) {
    return a == 0 || std::isinf(b) ? 0 : not_lost(a / b);
}

/// Returns the sum of two ends, rounded down, exact where it can be: its rounding error is a number.
double sum_below(double a, double b) {
    const double sum = a + b, share = sum - a, error = (a - (sum - share)) + (b - share);
    return error >= 0 ? sum : next_below(sum);
}

} // namespace

double Interval::middle() const {
    return std::clamp(lower / 2 + upper / 2, lower, upper);
}

double Interval::magnitude() const {
    return std::max(std::abs(lower), std::abs(upper));
}

Interval operator+(const Interval& a, const Interval& b) {
    if (a.empty() || b.empty())
        return Interval::none();
    return {sum_below(a.lower, b.lower), -sum_below(-a.upper, -b.upper), a.continuous && b.continuous};
}

Interval operator-(const Interval& a) {
    return {-a.upper, -a.lower, a.continuous};
}

Interval operator-(const Interval& a, const Interval& b) {
    return a + -b;
}

Interval operator*(const Interval& a, const Interval& b) {
    if (a.empty() || b.empty())
        return Interval::none();
    return rounded_hull({end_product(a.lower, b.lower), end_product(a.lower, b.upper), end_product(a.upper, b.lower),
                         end_product(a.upper, b.upper)},
                        a.continuous && b.continuous);
}

Interval operator/(const Interval& a, const Interval& b) {
    if (a.empty() || b.empty() || b.is_point(0))
        return Interval::none();
    if (!b.contains(0))
        return rounded_hull({end_quotient(a.lower, b.lower), end_quotient(a.lower, b.upper),
                             end_quotient(a.upper, b.lower), end_quotient(a.upper, b.upper)},
                            a.continuous && b.continuous);
    if (a.is_point(0))
        return {0, 0, false};
    Interval inverse = Interval::entire();
    if (b.lower == 0)
        inverse.lower = std::isinf(b.upper) ? 0 : next_below(1 / b.upper);
    else if (b.upper == 0)
        inverse.upper = std::isinf(b.lower) ? 0 : next_above(1 / b.lower);
    inverse.continuous = false;
    return a * inverse;
}

Interval intersection(const Interval& a, const Interval& b) {
    const Interval both{std::max(a.lower, b.lower), std::min(a.upper, b.upper), a.continuous && b.continuous};
    return both.empty() ? Interval::none() : both;
}

Interval hull(const Interval& a, const Interval& b) {
    if (a.empty() || b.empty())
        return a.empty() ? b : a;
    return {std::min(a.lower, b.lower), std::max(a.upper, b.upper), a.continuous && b.continuous};
}

Interval intersect_quotient(const Interval& within, const Interval& dividend, const Interval& divisor) {
    if (dividend.empty() || divisor.empty() || within.empty())
        return Interval::none();
    if (!divisor.contains(0))
        return intersection(within, dividend / divisor);
    if (dividend.contains(0))
        return within;
    // The parts of the divisor on either side of 0 give a ray each.
    Interval result = Interval::none();
    if (divisor.lower < 0)
        result = hull(result, intersection(within, dividend / Interval{divisor.lower, 0}));
    if (divisor.upper > 0)
        result = hull(result, intersection(within, dividend / Interval{0, divisor.upper}));
    return result;
}

} // namespace graze
