#include "layout/free_way.hpp"

#include "layout/grid_lengths.hpp"
#include "layout/mask_outlines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace graze {

namespace {

/// A part that moves by a share of the mass's travel.
struct SweptPart {
    const char* name;
    double share;
    std::vector<MaskEdge> left, right; ///< its vertical faces
    GridBox box;
};

/// @param inside true: the polygons are the part; false: they surround it
SweptPart swept_part(const char* name, double share, std::span<const GridPolygon> polygons, bool inside) {
    SweptPart part{name, share, {}, {}, bounding_box(polygons.front())};
    for (const GridPolygon& one : polygons)
        part.box = part.box.with(bounding_box(one));
    for (const MaskEdge& edge : mask_edges(polygons))
        if (edge.upright)
            (((edge.side > 0) == inside) ? part.left : part.right).push_back(edge);
    return part;
}

class Sweep {
public:
    Sweep(const DeviceDrawing& drawing, const EtchedWall& wall, double depth)
        : drawing_(&drawing), least_recess_(std::min(wall.recess(0), wall.recess(depth))) {}

    std::vector<FreeWay> find(std::span<const GridPolygon> front) {
        const std::vector<SweptPart> parts = parts_of(front);
        const double to_stops = way_to_stops(), to_electrode = etched(way_between(drawing_->electrode, drawing_->mass));
        std::vector<FreeWay> found;
        for (const SweptPart& one : parts)
            for (const SweptPart& other : parts)
                if (one.share != other.share && share_y(one, other))
                    if (auto way = first_meeting(one, other)) {
                        way->needed = way->to_stops ? to_stops : to_electrode;
                        found.push_back(std::move(*way));
                    }
        return found;
    }

private:
    double etched(std::int64_t drawn) const { return micrometres(drawn) + 2 * least_recess_; }

    static std::int64_t way_between(const GridPolygon& left, const GridPolygon& right) {
        const auto between = facing(left, right);
        return between ? between->distance : std::numeric_limits<std::int64_t>::max();
    }

    double way_to_stops() const {
        double least = std::numeric_limits<double>::infinity();
        for (const GridPolygon& stop : drawing_->stops)
            least = std::min(least, etched(way_between(drawing_->mass, stop)));
        return least;
    }

    std::vector<SweptPart> parts_of(std::span<const GridPolygon> front) const {
        // The outline of the frame is that of all other polygons; touching polygons count as one.
        std::vector<GridPolygon> beside(front.begin(), front.end());
        beside.push_back(drawing_->mass);
        beside.push_back(drawing_->electrode);
        beside.insert(beside.end(), drawing_->stops.begin(), drawing_->stops.end());
        std::vector<SweptPart> parts{swept_part("the mass", 1, std::span(&drawing_->mass, 1), true)};
        for (const bool in_lower : {false, true}) {
            for (const GridBox& beam : drawing_->flexure.beams)
                beside.push_back(polygon_of(drawing_->in_device(beam, in_lower)));
            for (const GridBox& truss : drawing_->flexure.trusses) {
                const GridPolygon outline = polygon_of(drawing_->in_device(truss, in_lower));
                beside.push_back(outline);
                parts.push_back(swept_part("a truss", share_of(truss), std::span(&outline, 1), true));
            }
        }
        parts.push_back(swept_part("the frame", 0, beside, false));
        return parts;
    }

    /// Share of a truss, by the number of beams between the frame and it.
    double share_of(const GridBox& truss) const {
        const std::vector<GridBox>& beams = drawing_->flexure.beams;
        const std::size_t half = beams.size() / 2;
        std::size_t within = 0; // including the outer one of those that it joins
        for (std::size_t i = 0; i < half; ++i)
            within +=
                (truss.right >= beams[half].right ? beams[half + i].right <= truss.right : beams[i].left >= truss.left)
                    ? 1U
                    : 0U;
        return static_cast<double>(within - 1) / static_cast<double>(half);
    }

    /// With a negative recess silicon grows around corners, too.
    std::int64_t grown() const {
        return least_recess_ < 0 ? std::llround(-2 * least_recess_ * grid_per_micrometre) : 0;
    }

    bool share_y(const SweptPart& one, const SweptPart& other) const {
        return one.box.bottom < other.box.top + grown() && other.box.bottom < one.box.top + grown();
    }

    /// Finds where two parts meet first, the first one being on the left.
    std::optional<FreeWay> first_meeting(const SweptPart& one, const SweptPart& other) const {
        std::optional<FreeWay> first;
        const double closing = std::abs(one.share - other.share);
        for (const MaskEdge& a : one.right)
            for (const MaskEdge& b : other.left) {
                const std::int64_t low = std::max(a.from, b.from), high = std::min(a.to, b.to);
                if (b.at < a.at || low >= high + grown())
                    continue;
                const double way = etched(b.at - a.at) / closing;
                if (first && way >= first->way)
                    continue;
                const GridPoint at{(a.at + b.at) / 2, (low + high) / 2};
                const bool in_notch = drawing_->has(drawing_->flexure.notch, at);
                first =
                    FreeWay{.way = way,
                            .needed = 0,
                            .to_stops = one.share > other.share,
                            .part = name_of(one, in_notch, at, a.at) + " meets " + name_of(other, in_notch, at, b.at),
                            .at = at,
                            .key = in_notch ? "flexure_spacing" : "clearance"};
            }
        return first;
    }

    /// Within the notches the frame's finger and the mass's lugs are at the same y.
    std::string name_of(const SweptPart& part, bool in_notch, GridPoint at, std::int64_t face) const {
        const FlexureDrawing& flexure = drawing_->flexure;
        const auto has = [&](const GridBox& box) { return drawing_->has(box, {face, at.y}); };
        if (in_notch && part.share == 0 && has(flexure.finger))
            return "the frame's finger";
        if (in_notch && part.share == 1 && std::any_of(flexure.lugs.begin(), flexure.lugs.end(), has))
            return "a lug of the mass";
        return part.name;
    }

    const DeviceDrawing* drawing_;
    double least_recess_; ///< um, least recess of a wall: there trenches are narrowest
};

} // namespace

std::vector<FreeWay> free_ways(const DeviceDrawing& drawing, std::span<const GridPolygon> front, const EtchedWall& wall,
                               double depth) {
    return Sweep(drawing, wall, depth).find(front);
}

} // namespace graze
