#pragma once

#include "graze/layout/grid_polygon.hpp"

#include <span>
#include <vector>

namespace graze {

/// Returns the outlines of the union of `boxes` minus `without`, within `clip`: axis-parallel polygons that do not
/// overlap. @throws InternalError for an area with a hole, which a mask's polygon cannot have
std::vector<GridPolygon> outlines(std::span<const GridBox> boxes, std::span<const GridBox> without,
                                  const GridBox& clip);

/// A straight part of the outline of the etched area.
struct MaskEdge {
    std::int64_t at = 0;           ///< x of a vertical edge, y of a horizontal one
    std::int64_t from = 0, to = 0; ///< interval along it
    int side = 1;                  ///< 1: the etched area is on the side of larger `at`
    bool upright = true;
};

/// Two edges that face each other with no other edge between them.
struct FacingEdges {
    bool etched = false; ///< true: a trench is between them; false: silicon
    std::int64_t distance = 0;
    GridPoint first, second; ///< on either edge, in the middle of the opposing part

    GridPoint middle() const { return {(first.x + second.x) / 2, (first.y + second.y) / 2}; }
};

/// Returns the outline of the union of axis-parallel polygons; edges where two touch cancel. Sides in other directions
/// are ignored.
std::vector<MaskEdge> mask_edges(std::span<const GridPolygon> polygons);

/// Returns for each edge the nearest ones that face it.
std::vector<FacingEdges> facing_edges(const std::vector<MaskEdge>& edges);

/// Whether a point is within a polygon or on its outline.
bool contains(const GridPolygon& polygon, GridPoint point);

} // namespace graze
