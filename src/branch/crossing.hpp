#pragma once

#include "graze/branch/continuation.hpp"

#include <optional>

namespace graze {

/// A test function at a place of the last step, given as a fraction of it.
struct TestValue {
    double fraction = 0, value = 0;
};

/// The point of the last step of a branch at which another branch crosses: where the determinant is zero. Nothing
/// can be solved there, and next to it Newton's method may end on either branch; so points at a safe distance on both
/// sides are made, through which polynomials tell where the zero is and what the branch does there.
std::optional<ContinuationPoint> locate_crossing(Continuation& continuation, const TestValue& low,
                                                 const TestValue& high);

/// Where between the last two of three points, whose values have the same sign, a test may yet have become zero twice:
/// where the parabola through them has its vertex, if that comes near zero or goes beyond.
std::optional<double> possible_dip(const TestValue& before, const TestValue& low, const TestValue& high);

} // namespace graze
