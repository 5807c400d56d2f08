#include "layout/mask_edges.hpp"

#include <algorithm>
#include <map>

namespace graze {

namespace {

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
