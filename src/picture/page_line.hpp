#pragma once

#include "picture/curve.hpp"
#include "picture/figure_layout.hpp"

#include <cstddef>
#include <vector>

namespace graze {

// Lines in the coordinates of the page, in points (1/72 inch).

/// Position on the page of a point of a panel.
PlanePoint on_page(const PlanePoint& point, const PanelLayout& layout);
/// The point of a panel at a position on the page.
PlanePoint off_page(const PlanePoint& point, const PanelLayout& layout);

/// A dash and the gap after it, in points.
struct DashPattern {
    double dash = 0, gap = 0;
    double length() const { return dash + gap; }
};
/// The pattern of dashed or dotted lines; a period of the dashes is two periods of the dots.
/// @param stroke factor of line widths
DashPattern dash_pattern(FigureSeries::Style style, double stroke);

/// The dashes of a line within the frame. Their positions depend only on the horizontal coordinate on the page, or on
/// the vertical one where the line is steep, and not on the beginning of the line: if lines coincide, so do their
/// dashes, and the gaps stay open.
/// @param line in the coordinates of the page
std::vector<Polyline> dashes_of(const Polyline& line, const DashPattern& pattern, const Box& frame);

/// Equidistant points on the part of a line within the frame.
/// @param first distance of the first point from the beginning of the line
std::vector<PlanePoint> spread_along(const Polyline& line, double distance, double first, const Box& frame);

/// For each series of a panel, the number of colours that are drawn later and cover most of its line; it must be drawn
/// wider to be visible. At most 2; all lines of a colour have the same number, series that are no lines have 0.
std::vector<std::size_t> covering_lines(const FigurePanel& panel, const PanelLayout& layout);

} // namespace graze
