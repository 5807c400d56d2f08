#pragma once

#include <limits>

namespace graze {

/// A closed interval of real numbers, empty if its lower end is not below or at its upper end. Results of operations
/// contain the results for all real numbers in their operands at which the operation is defined: their ends are rounded
/// outwards, + - * / and sqrt to the next number, functions of the C library, whose documented errors are at most 2
/// units in the last place, by 4 units. No operation gives NaN: an operation that is nowhere defined gives an empty
/// interval, one without bound an infinite end. R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval
/// Analysis, SIAM 2009; "set-based" in IEEE 1788.
struct Interval {
    double lower = 0, upper = 0;
    /// False if somewhere in its operands, or in theirs, an operation is undefined, infinite or discontinuous.
    bool continuous = true;

    static Interval point(double value) { return {value, value}; }
    static Interval entire() {
        return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    }
    static Interval none() {
        return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), false};
    }

    bool empty() const { return !(lower <= upper); }
    bool contains(double value) const { return lower <= value && value <= upper; }
    bool contains(const Interval& other) const { return lower <= other.lower && other.upper <= upper; }
    bool is_point(double value) const { return lower == value && upper == value; }
    bool bounded() const {
        return lower > -std::numeric_limits<double>::infinity() && upper < std::numeric_limits<double>::infinity();
    }
    /// Rounded; infinite or NaN unless it is bounded and not empty.
    double width() const { return upper - lower; }
    /// A number in it, near its middle. @returns NaN unless it is bounded and not empty
    double middle() const;
    /// Largest absolute value in it.
    double magnitude() const;
};

Interval operator+(const Interval& a, const Interval& b);
Interval operator-(const Interval& a, const Interval& b);
Interval operator*(const Interval& a, const Interval& b);
/// Division by an interval that contains 0 gives what the rest of it gives.
Interval operator/(const Interval& a, const Interval& b);
Interval operator-(const Interval& a);
/// Returns what both contain.
Interval intersection(const Interval& a, const Interval& b);
/// Returns the smallest interval that contains both.
Interval hull(const Interval& a, const Interval& b);
/// Returns an interval that contains all q in `within` for which q times a number in `divisor` is in `dividend`. Where
/// the divisor contains 0 these are two rays, and the gap between them shortens the result.
Interval intersect_quotient(const Interval& within, const Interval& dividend, const Interval& divisor);

} // namespace graze
