#pragma once

#include "graze/picture/figure.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

using Polyline = std::vector<PlanePoint>;

/// Leaves out points that nobody would miss: the rest is nowhere further than `distance` from the line that was
/// given (Ramer 1972; Douglas and Peucker 1973).
/// @param width, height what the two axes span; distances are in terms of them
Polyline simplified(std::span<const PlanePoint> line, double width, double height, double distance);

/// More points between those that are given, along cubics that keep the direction at each of them and go beyond none
/// (Fritsch and Butland 1984). Where there is a corner, and between points that are not farther along, lines stay
/// straight or begin anew.
/// @param along how far along the curve each point is; @param corners indices of points
Polyline smoothed(std::span<const PlanePoint> line, std::span<const double> along,
                  std::span<const std::size_t> corners);

/// @param name of the axis, for the message
/// @throws InputError unless numbers from `low` to `high` can be told apart on an axis
void require_drawable(double low, double high, const std::string& name);

/// Limits and tic distance of an axis.
struct Axis {
    double low = 0, high = 1, tic = 0.5;
};
/// An axis for values between these, with about as many tics as wanted and a margin (a fraction of the span).
Axis axis_for(double least, double greatest, int tics, double margin);

} // namespace graze
