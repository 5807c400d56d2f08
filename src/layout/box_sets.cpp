#include "layout/box_sets.hpp"
#include "graze/base/input_error.hpp"

#include <boost/polygon/polygon.hpp>

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

} // namespace graze
