#pragma once

#include "graze/layout/grid_polygon.hpp"

#include <span>
#include <vector>

namespace graze {

/// Outlines of what is in any of `boxes`, in none of `without` and within `clip`: polygons with sides along the axes,
/// which do not overlap. @throws InternalError when one has a hole, which a mask's polygon cannot have
std::vector<GridPolygon> outlines(std::span<const GridBox> boxes, std::span<const GridBox> without,
                                  const GridBox& clip);

} // namespace graze
