#pragma once

#include "graze/branch/continuation.hpp"

#include <functional>
#include <optional>
#include <span>

namespace graze {

/// A test function at a place of the last step, given as a fraction of it.
struct TestValue {
    double fraction = 0, value = 0;
};

/// A test function of points of a branch; NaN where it has no value.
using PointTest = std::function<double(const ContinuationPoint&)>;

/// The point of the last step of a branch at which a test is zero, where another branch crosses: by the determinant
/// that crossing itself, by others what lies beside it. Nothing can be solved at a crossing, and next to it Newton's
/// method may end on either branch; so points at a safe distance on both sides are made, through which polynomials tell
/// where the zero is and what the branch does there.
std::optional<ContinuationPoint> locate_crossing(Continuation& continuation, const PointTest& test,
                                                 const TestValue& low, const TestValue& high, double reach = 1);
/// @param offsets of those points from where the zero is thought to be, in rising order, as fractions of the step
/// @param reach by which they are shortened: where another zero is near
std::optional<ContinuationPoint> locate_crossing(Continuation& continuation, const PointTest& test,
                                                 const TestValue& low, const TestValue& high,
                                                 std::span<const double> offsets, double reach = 1);

/// Where between the last two of three points, whose values have the same sign, a test may yet have become zero twice:
/// where the parabola through them has its vertex, if that comes near zero or goes beyond.
std::optional<double> possible_dip(const TestValue& before, const TestValue& low, const TestValue& high);
/// A test between two of its zeros, and not far before and behind them.
struct Dip {
    TestValue before, within, behind;
};
/// Looks by further parabolas for a place between two values of the same sign where the test has the other one.
/// @param within where the test may be least; @param value_at the test there, NaN where it has no value
std::optional<Dip> dip_between(TestValue low, TestValue high, double within,
                               const std::function<double(double)>& value_at);

} // namespace graze
