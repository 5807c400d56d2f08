#include "program/curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace graze {

namespace {

/// Distance of p from the stretch between a and b.
double distance_from(PlanePoint p, PlanePoint a, PlanePoint b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double square = dx * dx + dy * dy;
    double share = square > 0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / square : 0;
    share = std::clamp(share, 0.0, 1.0);
    return std::hypot(p.x - a.x - share * dx, p.y - a.y - share * dy);
}

} // namespace

Polyline simplified(std::span<const PlanePoint> line, double width, double height, double distance) {
    if (line.size() < 3)
        return {line.begin(), line.end()};
    const auto scaled = [&](std::size_t i) { return PlanePoint{line[i].x / width, line[i].y / height}; };
    std::vector<bool> kept(line.size(), false);
    kept.front() = kept.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        double furthest = distance;
        std::size_t split = 0;
        for (std::size_t i = first + 1; i < last; ++i) {
            const double away = distance_from(scaled(i), scaled(first), scaled(last));
            if (away > furthest) {
                furthest = away;
                split = i;
            }
        }
        if (split == 0)
            continue;
        kept[split] = true;
        open.emplace_back(first, split);
        open.emplace_back(split, last);
    }
    Polyline result;
    for (std::size_t i = 0; i < line.size(); ++i)
        if (kept[i])
            result.push_back(line[i]);
    return result;
}

Axis axis_for(double least, double greatest, int tics, double margin) {
    if (!(least <= greatest))
        return {};
    double span = greatest - least;
    const double size = std::max(std::abs(least), std::abs(greatest));
    if (span <= 1e-9 * size || span == 0) { // a constant: room for its value in the middle
        span = size > 0 ? 0.2 * size : 2;
        least -= span / 2;
        greatest += span / 2;
    }
    const double rough = span / tics;
    const double power = std::pow(10, std::floor(std::log10(rough)));
    const double lead = rough / power;
    Axis axis;
    axis.tic = power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
    axis.low = least - margin * span;
    axis.high = greatest + margin * span;
    return axis;
}

} // namespace graze
