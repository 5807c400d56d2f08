#pragma once

#include "picture/figure_layout.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// A dot of one of a panel's series.
struct MingledDot {
    PlanePoint at;
    std::size_t series = 0;
};

/// The dots of all series of a panel in the order in which they are drawn: where series lie on one another, each is
/// seen, however many dots it has. Of dots of a series that nobody could tell apart only one is there.
std::vector<MingledDot> mingled_dots(const FigurePanel& panel, const PanelLayout& layout);

} // namespace graze
