#include "graze/layout/grid_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace graze {

namespace {

/// Twice the signed area of a triangle, positive to the left of a to b; does not overflow for coordinates within a
/// metre.
std::int64_t turn(GridPoint a, GridPoint b, GridPoint c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

int sign(std::int64_t value) {
    return value > 0 ? 1 : value < 0 ? -1 : 0;
}

bool is_between(std::int64_t value, std::int64_t one, std::int64_t other) {
    return std::min(one, other) <= value && value <= std::max(one, other);
}

bool is_on(GridPoint point, GridPoint a, GridPoint b) {
    return turn(a, b, point) == 0 && is_between(point.x, a.x, b.x) && is_between(point.y, a.y, b.y);
}

bool meet(GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
    if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
        std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
        return false;
    return (sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 && sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0) ||
           is_on(c, a, b) || is_on(d, a, b) || is_on(a, c, d) || is_on(b, c, d);
}

} // namespace

GridBox GridBox::with(const GridBox& other) const {
    return {std::min(left, other.left), std::min(bottom, other.bottom), std::max(right, other.right),
            std::max(top, other.top)};
}

bool GridBox::contains(const GridBox& other) const {
    return left <= other.left && other.right <= right && bottom <= other.bottom && other.top <= top;
}

GridPolygon polygon_of(const GridBox& box) {
    return {{box.left, box.bottom}, {box.right, box.bottom}, {box.right, box.top}, {box.left, box.top}};
}

GridBox bounding_box(std::span<const GridPoint> corners) {
    if (corners.empty())
        return {};
    GridBox box{corners[0].x, corners[0].y, corners[0].x, corners[0].y};
    for (const GridPoint& one : corners)
        box = box.with({one.x, one.y, one.x, one.y});
    return box;
}

std::int64_t twice_area(std::span<const GridPoint> corners) {
    // Unsigned sums may wrap, but twice an area within two metres square fits, so the result is exact.
    std::uint64_t twice = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const GridPoint &a = corners[i], &b = corners[(i + 1) % corners.size()];
        twice += static_cast<std::uint64_t>(a.x - b.x) * static_cast<std::uint64_t>(a.y + b.y);
    }
    return static_cast<std::int64_t>(twice);
}

double area_of(std::span<const GridPoint> corners) {
    constexpr double square_nanometres = 1e6; // per square micrometre
    return std::abs(static_cast<double>(twice_area(corners))) / 2 / square_nanometres;
}

double total_area(std::span<const GridPolygon> polygons) {
    double sum = 0;
    for (const GridPolygon& one : polygons)
        sum += area_of(one);
    return sum;
}

std::optional<Facing> facing(std::span<const GridPoint> left, std::span<const GridPoint> right) {
    std::optional<Facing> nearest;
    for (std::size_t i = 0; i < left.size(); ++i)
        for (std::size_t j = 0; j < right.size(); ++j) {
            const GridPoint &a = left[i], &b = left[(i + 1) % left.size()];
            const GridPoint &c = right[j], &d = right[(j + 1) % right.size()];
            if (a.x != b.x || c.x != d.x || c.x < a.x)
                continue;
            const std::int64_t common =
                std::min(std::max(a.y, b.y), std::max(c.y, d.y)) - std::max(std::min(a.y, b.y), std::min(c.y, d.y));
            if (common <= 0)
                continue;
            const std::int64_t distance = c.x - a.x;
            if (!nearest || distance < nearest->distance)
                nearest = Facing{distance, 0};
            if (distance == nearest->distance)
                nearest->length += common;
        }
    return nearest;
}

std::optional<PolygonFault> polygon_fault(std::span<const GridPoint> corners, std::int64_t least) {
    const std::size_t n = corners.size();
    if (n < 3)
        return PolygonFault{"has fewer than three corners", n > 0 ? corners[0] : GridPoint()};
    for (std::size_t i = 0; i < n; ++i) {
        const GridPoint &a = corners[i], &b = corners[(i + 1) % n], &c = corners[(i + 2) % n];
        const std::int64_t ahead = (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y);
        if (std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y)) < static_cast<double>(least))
            return PolygonFault{"has a step that is too small", a};
        if (turn(a, b, c) == 0)
            return PolygonFault{"turns back, or has a straight corner", b};
        if (ahead < 0)
            return PolygonFault{"has an acute angle", b};
    }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 2; j < n; ++j)
            if ((j + 1) % n != i && meet(corners[i], corners[i + 1], corners[j], corners[(j + 1) % n]))
                return PolygonFault{"intersects itself", corners[j]};
    return std::nullopt;
}

} // namespace graze
