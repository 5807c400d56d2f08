#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// A point in whole nanometres.
struct GridPoint {
    std::int64_t x = 0, y = 0;
    friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

struct GridBox {
    std::int64_t left = 0, bottom = 0, right = 0, top = 0;

    std::int64_t width() const { return right - left; }
    std::int64_t height() const { return top - bottom; }
    GridBox moved(GridPoint by) const { return {left + by.x, bottom + by.y, right + by.x, top + by.y}; }
    /// Expands the box on each side.
    GridBox grown(std::int64_t by_x, std::int64_t by_y) const {
        return {left - by_x, bottom - by_y, right + by_x, top + by_y};
    }
    GridBox with(const GridBox& other) const; ///< smallest box that contains both
    bool contains(const GridBox& other) const;
    bool contains(GridPoint point) const { return contains(GridBox{point.x, point.y, point.x, point.y}); }
    GridPoint middle() const { return {(left + right) / 2, (bottom + top) / 2}; }
    /// Whether they share a point, including points on their edges.
    bool meets(const GridBox& other) const {
        return left <= other.right && other.left <= right && bottom <= other.top && other.bottom <= top;
    }
    friend bool operator==(const GridBox&, const GridBox&) = default;
};

/// Consecutive corners; the last is joined to the first, which is not repeated.
using GridPolygon = std::vector<GridPoint>;

GridPolygon polygon_of(const GridBox& box);
GridBox bounding_box(std::span<const GridPoint> corners);
/// Twice the area in square nanometres, positive for counterclockwise corners; exact for sides up to two metres.
std::int64_t twice_area(std::span<const GridPoint> corners);
/// Area in square micrometres, positive; computed exactly before rounding to a double.
double area_of(std::span<const GridPoint> corners);
double total_area(std::span<const GridPolygon> polygons);

/// Distance along x between two axis-parallel polygons where they face each other: the smallest one between vertical
/// edges with a common part in y, and the length over which it occurs.
struct Facing {
    std::int64_t distance = 0, length = 0; ///< nanometres
};
/// @return nothing if they do not face each other
std::optional<Facing> facing(std::span<const GridPoint> left, std::span<const GridPoint> right);

/// Why a polygon cannot be fabricated, and where.
struct PolygonFault {
    std::string text;
    GridPoint at;
};
/// @param least shortest allowed edge; shorter ones are accidental
/// @return nothing for a polygon that has an area, does not intersect itself, and has no acute angle, straight corner
/// or too short edge
std::optional<PolygonFault> polygon_fault(std::span<const GridPoint> corners, std::int64_t least);

} // namespace graze
