#pragma once

#include "picture/curve.hpp"
#include "picture/figure_layout.hpp"

#include <vector>

namespace graze {

// Lines in the coordinates of the page, where lengths are points.

/// Where a point of a panel lies on the page.
PlanePoint on_page(const PlanePoint& point, const PanelLayout& layout);
/// And back.
PlanePoint off_page(const PlanePoint& point, const PanelLayout& layout);

/// A dash and the gap behind it, in points.
struct DashPattern {
    double dash = 0, gap = 0;
    double length() const { return dash + gap; }
};
/// That of dashed or dotted lines. Two periods of the dots are one of the dashes.
DashPattern dash_pattern(FigureSeries::Style style, double stroke);

/// The dashes of a line as far as it runs in the frame. Where they lie depends on the place on the page alone, across
/// it where a line is rather level, up it where it is steep, and not on where the line begins: dashes of lines that
/// coincide coincide, and their gaps stay open.
/// @param line on the page
std::vector<Polyline> dashes_of(const Polyline& line, const DashPattern& pattern, const Box& frame);

/// Points along a line in the frame, at equal distances.
/// @param first distance of the first from where the line begins
std::vector<PlanePoint> spread_along(const Polyline& line, double distance, double first, const Box& frame);

} // namespace graze
