#pragma once

#include "graze/picture/figure.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// Some crosses of one of a panel's series.
struct CrossLayer {
    std::size_t series = 0;
    std::vector<PlanePoint> points;
};

/// Of several series of crosses that follow one another in a panel the last; of another series itself.
std::size_t last_of_crosses(const FigurePanel& panel, std::size_t series);

/// The crosses of such series in layers, in the order in which they are drawn: now one series comes last and now
/// another, so that none lies on all of the others.
std::vector<CrossLayer> mingled_crosses(const FigurePanel& panel, std::size_t first, std::size_t last);

} // namespace graze
