#pragma once

#include "picture/figure_layout.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

// Dots and crosses in an order in which no series covers the others.

/// A dot of one of a panel's series.
struct InterleavedDot {
    PlanePoint at;
    std::size_t series = 0;
};

/// The dots of all series of a panel in drawing order. Where series overlap, each is visible, whatever its number of
/// dots. Indistinguishable dots of a series are merged.
std::vector<InterleavedDot> interleaved_dots(const FigurePanel& panel, const PanelLayout& layout);

/// A vertical stroke that replaces dots of a series that touch one another.
struct DotStroke {
    PlanePoint from, to; ///< ends of the stroke in the coordinates of the panel
    std::size_t series = 0;
    std::size_t layer = 0; ///< layers are drawn one after the other, and the strokes of a layer series by series
};

/// Replaces dense dots by vertical strokes with the same appearance, about a tenth as many. Horizontal positions are
/// rounded to less than half a point, which is invisible in print; vertical positions are exact. Strokes are assigned
/// to a few layers pseudo-randomly, so that no series covers the others.
/// @param dots in drawing order: a later dot covers earlier ones
/// @param width of the dots, and of the strokes, in points
std::vector<DotStroke> dot_strokes(std::span<const InterleavedDot> dots, const PanelLayout& layout, double width);

/// A part of the crosses of one series of a panel.
struct CrossLayer {
    std::size_t series = 0;
    std::vector<PlanePoint> points;
};

/// The last of consecutive series of crosses in a panel, beginning with `series`; `series` itself if it has no crosses.
std::size_t last_of_crosses(const FigurePanel& panel, std::size_t series);

/// The crosses of consecutive series in layers, in drawing order. The order of the series changes from layer to layer,
/// so that no series covers all others.
std::vector<CrossLayer> interleaved_crosses(const FigurePanel& panel, std::size_t first, std::size_t last);

} // namespace graze
