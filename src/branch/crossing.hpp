#pragma once

#include "branch/test_dip.hpp"
#include "graze/branch/continuation.hpp"

#include <functional>
#include <optional>
#include <span>
#include <utility>

namespace graze {

/// A test function of points of a branch; NaN where it is not defined.
using PointTest = std::function<double(const ContinuationPoint&)>;

/// Offsets of points from an estimated zero, as fractions of the step: near enough for an accurate polynomial, far
/// enough for Newton's method to stay on the branch.
inline constexpr double usual_offsets[] = {-0.12, -0.09, -0.06, -0.03, 0.03, 0.06, 0.09, 0.12};

/// Locates the zero of a test function within the last step, near a crossing of two branches: the crossing itself if
/// the test is the determinant, or another point beside it. The equations are singular at a crossing, and near it
/// Newton's method may converge to either branch. Therefore points at a safe distance on both sides are computed, and
/// polynomials through them give the zero and the branch there.
/// @param reach factor that shortens the offsets where another zero is near
/// @param offsets of the points from the estimated zero, in increasing order, as fractions of the step
std::optional<ContinuationPoint> locate_crossing(Continuation& continuation, const PointTest& test,
                                                 const TestValue& low, const TestValue& high, double reach = 1,
                                                 std::span<const double> offsets = usual_offsets);

/// Locates two crossings with other branches that are so close that Newton's method cannot be used between them: both
/// are zeros of a polynomial through points on both sides. The points come nearer until the zeros no longer change.
std::optional<std::pair<ContinuationPoint, ContinuationPoint>> locate_pair(Continuation& continuation,
                                                                           const PointTest& test, const Dip& dip);

} // namespace graze
