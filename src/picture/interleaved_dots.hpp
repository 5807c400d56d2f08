#pragma once

#include "picture/figure_layout.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// A dot of one of a panel's series.
struct InterleavedDot {
    PlanePoint at;
    std::size_t series = 0;
};

/// The dots of all series of a panel in drawing order. Where series overlap, each is visible, whatever its number of
/// dots. Indistinguishable dots of a series are merged.
std::vector<InterleavedDot> interleaved_dots(const FigurePanel& panel, const PanelLayout& layout);

} // namespace graze
