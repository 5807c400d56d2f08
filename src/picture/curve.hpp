#pragma once

#include "graze/picture/figure.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

using Polyline = std::vector<PlanePoint>;

/// Leaves out points of a line: the result is nowhere farther than `distance` from the given line (Ramer 1972; Douglas
/// and Peucker 1973).
/// @param width, height ranges of the two axes, which are the units of `distance`
Polyline simplified(std::span<const PlanePoint> line, double width, double height, double distance);

/// Adds points between the given ones along monotone cubics with continuous direction, which do not overshoot (Fritsch
/// and Butland 1984). At corners a new piece begins; intervals in which `along` does not increase stay straight.
/// @param along arclength or time of each point; of another length: no smoothing. @param corners indices of points
Polyline smoothed(std::span<const PlanePoint> line, std::span<const double> along,
                  std::span<const std::size_t> corners);

/// Checks the limits of an axis. @param name of the axis, for the message
/// @throws InputError unless numbers from `low` to `high` can be drawn in double precision
void require_drawable(double low, double high, const std::string& name);

/// Limits and tic distance of an axis.
struct Axis {
    double low = 0, high = 1, tic = 0.5;
};
/// An axis for values between these, with about as many tics as wanted and a margin (a fraction of the span).
Axis axis_for(double least, double greatest, int tics, double margin);

} // namespace graze
