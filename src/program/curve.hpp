#pragma once

#include "graze/study/figure.hpp"

#include <span>
#include <vector>

namespace graze {

using Polyline = std::vector<PlanePoint>;

/// Leaves out points that nobody would miss: the rest is nowhere further than `distance` from the line that was
/// given (Ramer 1972; Douglas and Peucker 1973).
/// @param width, height what the two axes span; distances are in terms of them
Polyline simplified(std::span<const PlanePoint> line, double width, double height, double distance);

/// Limits and tic distance of an axis.
struct Axis {
    double low = 0, high = 1, tic = 0.5;
};
/// An axis for values between these, with about as many tics as wanted and a margin (a fraction of the span).
Axis axis_for(double least, double greatest, int tics, double margin);

} // namespace graze
