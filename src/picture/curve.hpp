#pragma once

#include "graze/picture/figure.hpp"
#include "graze/study/point_motion.hpp"

#include <cstddef>
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

/// True when a cyclic value wraps around between two rows. @param period 0: the value is not cyclic
bool wraps_around(double from, double to, double period);

/// The curve through the rows of a motion, interrupted at the beginning of arcs and where a phase wraps around.
/// @param x, y indices of its values
std::vector<PlanePoint> curve_of(const DenseMotion& motion, std::size_t x, std::size_t y);

/// Values over a rectangular grid, row by row from the lowest y; a value that is not finite is missing.
struct ContourGrid {
    std::vector<double> x, y; ///< rising
    std::vector<double> values;
};

/// Levels at round numbers strictly between the least and the greatest value, approximately `about` of them.
std::vector<double> contour_levels(const ContourGrid& grid, std::size_t about);

/// The contour line of a level, with values interpolated along the edges of cells: pieces of two points each, with a
/// point that is not finite after each piece.
std::vector<PlanePoint> contour_line(const ContourGrid& grid, double level);

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
