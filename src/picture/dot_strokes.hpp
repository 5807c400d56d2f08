#pragma once

#include "picture/figure_layout.hpp"
#include "picture/interleaved_dots.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// A vertical stroke that replaces dots of a series that touch one another.
struct DotStroke {
    PlanePoint from, to; ///< ends of the stroke in the coordinates of the panel
    std::size_t series = 0;
    std::size_t layer = 0; ///< layers are drawn one after the other, and the strokes of a layer series by series
};

/// Number of layers. Strokes are assigned to layers pseudo-randomly, so that no series covers the others.
inline constexpr std::size_t stroke_layers = 6;

/// Replaces dense dots by vertical strokes with the same appearance, about a tenth as many. Horizontal positions are
/// rounded to less than half a point, which is invisible in print; vertical positions are exact.
/// @param dots in drawing order: a later dot covers earlier ones
/// @param width of the dots, and of the strokes, in points
std::vector<DotStroke> dot_strokes(std::span<const InterleavedDot> dots, const PanelLayout& layout, double width);

} // namespace graze
