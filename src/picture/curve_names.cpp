#include "picture/curve_names.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

// In widths of the view.
constexpr double height_of_view = 0.65; ///< about that of a panel
constexpr double step = 0.01;           ///< distance of the tried places along a curve
constexpr double room = 0.1;            ///< more distance is no better
constexpr double margin = 0.03;         ///< of the view, in which no name stands
constexpr double of_points = 2;         ///< points need more distance than curves, since they have labels

/// Points of lines at small distances, in widths of the view, as far as they lie in it.
std::vector<PlanePoint> spread(const std::vector<Polyline>& lines, const Box& view) {
    const Box inner{0, 0, 1, height_of_view};
    const auto scaled = [&](const PlanePoint& point) {
        return PlanePoint{(point.x - view.left) / view.width(), height_of_view * (point.y - view.low) / view.height()};
    };
    std::vector<PlanePoint> points;
    for (const Polyline& line : lines)
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const PlanePoint from = scaled(line[i]), to = scaled(line[i + 1]);
            if (!std::isfinite(from.x + from.y + to.x + to.y) || !part_within(from, to, inner))
                continue;
            const auto parts = 1 + static_cast<std::size_t>(std::min(distance_of(from, to), 10.0) / step);
            for (std::size_t part = 0; part <= parts; ++part)
                if (const PlanePoint at = between(from, to, static_cast<double>(part) / static_cast<double>(parts));
                    inner.holds(at))
                    points.push_back(at);
        }
    return points;
}

double distance_from(const PlanePoint& at, const std::vector<PlanePoint>& points) {
    double least = infinity;
    for (const PlanePoint& point : points)
        least = std::min(least, distance_of(at, point));
    return least;
}

} // namespace

std::vector<std::optional<PlanePoint>> places_of_names(const std::vector<std::vector<Polyline>>& curves,
                                                       const std::vector<PlanePoint>& avoided, const Box& view) {
    std::vector<std::vector<PlanePoint>> all;
    for (const std::vector<Polyline>& lines : curves)
        all.push_back(spread(lines, view));
    std::vector<PlanePoint> taken; // by points and names
    for (const PlanePoint& point : avoided)
        for (const PlanePoint& at : spread({{point, point}}, view))
            taken.push_back(at);
    const Box inner = Box{0, 0, 1, height_of_view}.grown(-margin);
    std::vector<std::optional<PlanePoint>> places;
    for (std::size_t c = 0; c < all.size(); ++c) {
        double best = -1;
        PlanePoint place;
        for (const PlanePoint& at : all[c]) {
            double free = std::min(room, distance_from(at, taken) / of_points);
            for (std::size_t other = 0; other < all.size() && free > best; ++other)
                if (other != c)
                    free = std::min(free, distance_from(at, all[other]));
            free -= inner.holds(at) ? 0 : room; // a place beside the frame is the last choice
            if (free > best) {
                best = free;
                place = at;
            }
        }
        places.emplace_back();
        if (all[c].empty())
            continue;
        taken.push_back(place);
        places.back() = {view.left + place.x * view.width(), view.low + place.y / height_of_view * view.height()};
    }
    return places;
}

} // namespace graze
