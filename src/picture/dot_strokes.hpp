#pragma once

#include "picture/figure_layout.hpp"
#include "picture/mingled_dots.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Dots of a series that lie above one another so densely that they make a line.
struct DotStroke {
    PlanePoint from, to; ///< in the coordinates of the panel; the ends of the ink
    std::size_t series = 0;
    std::size_t layer = 0; ///< strokes of a layer are drawn series by series, and layers one after the other
};

/// How many layers there are: in which one a stroke is looks like chance, so that no series lies on the others.
inline constexpr std::size_t stroke_layers = 6;

/// The ink of crowds of dots as upright strokes. What hundreds of thousands of dots show is shown by a tenth as many:
/// where they are is rounded sidewise to less than half a point, which nobody sees in print; upward it is not.
/// @param dots in the order in which they are drawn: the last one in a place is seen
/// @param width of the dots, and of the strokes, in points
std::vector<DotStroke> dot_strokes(std::span<const MingledDot> dots, const PanelLayout& layout, double width);

} // namespace graze
