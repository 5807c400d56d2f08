#pragma once

#include "graze/picture/figure.hpp"

#include <cstddef>
#include <vector>

namespace graze {

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
