#pragma once

#include "graze/layout/grid_polygon.hpp"

#include <span>
#include <vector>

namespace graze {

/// A straight part of the outline of what is etched.
struct MaskEdge {
    std::int64_t at = 0;           ///< x of an upright edge, y of a level one
    std::int64_t from = 0, to = 0; ///< along it
    int side = 1;                  ///< 1 where what is etched lies beyond greater values of `at`
    bool upright = true;
};

/// Two edges that face each other with nothing between them.
struct FacingEdges {
    bool etched = false; ///< what is between them: a trench, or silicon
    std::int64_t distance = 0;
    GridPoint first, second; ///< on either edge, in the middle of what faces

    GridPoint middle() const { return {(first.x + second.x) / 2, (first.y + second.y) / 2}; }
};

/// The outline of polygons with sides along the axes, as of one area: where two touch, nothing remains. Sides in other
/// directions are left out.
std::vector<MaskEdge> mask_edges(std::span<const GridPolygon> polygons);

/// For each edge the nearest ones that face it.
std::vector<FacingEdges> facing_edges(const std::vector<MaskEdge>& edges);

/// Whether a point is within a polygon or on its outline.
bool contains(const GridPolygon& polygon, GridPoint point);

} // namespace graze
