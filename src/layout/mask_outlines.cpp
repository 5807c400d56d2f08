#include "layout/mask_outlines.hpp"

#include "graze/base/input_error.hpp"

#include <boost/polygon/polygon.hpp>

#include <algorithm>
#include <map>

namespace graze {

namespace {

namespace planar = boost::polygon;
using Coordinate = int;
using BoxSet = planar::polygon_90_set_data<Coordinate>;

planar::rectangle_data<Coordinate> rectangle(const GridBox& box) {
    return {static_cast<Coordinate>(box.left), static_cast<Coordinate>(box.bottom), static_cast<Coordinate>(box.right),
            static_cast<Coordinate>(box.top)};
}

BoxSet set_of(std::span<const GridBox> boxes, const GridBox& clip) {
    BoxSet set;
    for (const GridBox& box : boxes)
        if (box.width() > 0 && box.height() > 0 && box.meets(clip))
            set.insert(rectangle(box));
    return set;
}

/// Corners of a polygon, without those on straight sides.
GridPolygon corners_of(const planar::polygon_90_with_holes_data<Coordinate>& polygon) {
    GridPolygon all;
    for (const auto& point : polygon)
        if (const GridPoint one{point.x(), point.y()}; all.empty() || all.back() != one)
            all.push_back(one);
    while (all.size() > 1 && all.front() == all.back())
        all.pop_back();
    GridPolygon corners;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const GridPoint &before = all[(i + all.size() - 1) % all.size()], &after = all[(i + 1) % all.size()];
        if (!(before.x == all[i].x && after.x == all[i].x) && !(before.y == all[i].y && after.y == all[i].y))
            corners.push_back(all[i]);
    }
    return corners;
}

/// Changes of the coverage beyond a line, along it: number of polygons that begin minus those that end.
using Changes = std::map<std::int64_t, int>;

void add_edges(const std::map<std::int64_t, Changes>& lines, bool upright, std::vector<MaskEdge>& edges) {
    for (const auto& [at, changes] : lines) {
        int sum = 0;
        std::int64_t from = 0;
        for (const auto& [along, change] : changes) {
            if (change == 0)
                continue;
            if (sum != 0)
                edges.push_back({at, from, along, sum > 0 ? 1 : -1, upright});
            sum += change;
            from = along;
        }
    }
}

} // namespace

std::vector<GridPolygon> outlines(std::span<const GridBox> boxes, std::span<const GridBox> without,
                                  const GridBox& clip) {
    using planar::operators::operator-=;
    using planar::operators::operator&=;
    BoxSet set = set_of(boxes, clip);
    const BoxSet taken = set_of(without, clip);
    set -= taken;
    const auto window = rectangle(clip);
    set &= window;
    std::vector<planar::polygon_90_with_holes_data<Coordinate>> polygons;
    set.get(polygons);
    std::vector<GridPolygon> result;
    for (const auto& polygon : polygons) {
        if (polygon.begin_holes() != polygon.end_holes())
            throw InternalError("a drawn polygon has a hole");
        result.push_back(corners_of(polygon));
    }
    return result;
}

std::vector<MaskEdge> mask_edges(std::span<const GridPolygon> polygons) {
    std::map<std::int64_t, Changes> upright, level;
    for (const GridPolygon& polygon : polygons) {
        const int sense = twice_area(polygon) >= 0 ? 1 : -1;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const GridPoint &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            if (a.x == b.x) { // the interior is to the left of an edge: beyond it if the edge goes down
                const int side = b.y < a.y ? sense : -sense;
                upright[a.x][std::min(a.y, b.y)] += side;
                upright[a.x][std::max(a.y, b.y)] -= side;
            } else if (a.y == b.y) {
                const int side = b.x > a.x ? sense : -sense;
                level[a.y][std::min(a.x, b.x)] += side;
                level[a.y][std::max(a.x, b.x)] -= side;
            }
        }
    }
    std::vector<MaskEdge> edges;
    add_edges(upright, true, edges);
    add_edges(level, false, edges);
    return edges;
}

std::vector<FacingEdges> facing_edges(const std::vector<MaskEdge>& edges) {
    std::vector<FacingEdges> found;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const MaskEdge& one = edges[i];
        std::int64_t nearest = -1;
        for (std::size_t k = i + 1; k < edges.size() && edges[k].upright == one.upright; ++k) { // in increasing order
            const MaskEdge& other = edges[k];
            const std::int64_t low = std::max(one.from, other.from), high = std::min(one.to, other.to);
            if (low >= high || other.at == one.at)
                continue;
            if (nearest >= 0 && other.at - one.at > nearest)
                break;
            if (other.side == one.side)
                continue;
            nearest = other.at - one.at;
            const std::int64_t along = (low + high) / 2;
            const GridPoint first = one.upright ? GridPoint{one.at, along} : GridPoint{along, one.at};
            const GridPoint second = one.upright ? GridPoint{other.at, along} : GridPoint{along, other.at};
            found.push_back({one.side > 0, nearest, first, second});
        }
    }
    return found;
}

bool contains(const GridPolygon& polygon, GridPoint point) {
    bool within = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const GridPoint &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double cross = static_cast<double>(b.x - a.x) * static_cast<double>(point.y - a.y) -
                             static_cast<double>(b.y - a.y) * static_cast<double>(point.x - a.x);
        if (cross == 0 && std::min(a.x, b.x) <= point.x && point.x <= std::max(a.x, b.x) &&
            std::min(a.y, b.y) <= point.y && point.y <= std::max(a.y, b.y))
            return true;
        if ((a.y > point.y) != (b.y > point.y) && (cross > 0) == (b.y > a.y))
            within = !within;
    }
    return within;
}

} // namespace graze
