#pragma once

#include "graze/layout/grid_polygon.hpp"

#include <span>
#include <vector>

namespace graze {

/// Returns the outlines of the union of `boxes` minus `without`, within `clip`: axis-parallel polygons that do not
/// overlap. @throws InternalError for an area with a hole, which a mask's polygon cannot have
std::vector<GridPolygon> outlines(std::span<const GridBox> boxes, std::span<const GridBox> without,
                                  const GridBox& clip);

} // namespace graze
