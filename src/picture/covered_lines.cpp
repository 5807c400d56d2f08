#include "picture/covered_lines.hpp"

#include "picture/curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_set>

namespace graze {

namespace {

constexpr double square_side = 0.4; ///< side of a square in points; lines that are further apart are both visible
constexpr double least_common_length = 30; ///< least common length in points of covered lines; crossings are shorter
constexpr double covered_share = 0.7;      ///< least covered fraction of a line; otherwise enough of it is visible
constexpr std::size_t most_layers = 2;
constexpr double longest_line = 1e5; ///< points; limits the work for lines that leave the page

using Squares = std::unordered_set<std::uint64_t>;

bool is_line(const FigureSeries& series) {
    using Style = FigureSeries::Style;
    return series.style == Style::line || series.style == Style::dashed || series.style == Style::dotted;
}

/// The square of a point of the page; coordinates are not negative.
std::uint64_t square_at(const PlanePoint& point) {
    return static_cast<std::uint64_t>(point.x / square_side) << 32 | static_cast<std::uint64_t>(point.y / square_side);
}

/// Calls `visit` with points of a line in the frame, at most half a square apart.
template <class Visit>
void walk(const FigureSeries& series, const FigurePanel& panel, const PanelLayout& layout, Visit visit) {
    const Box& frame = layout.frame;
    const auto place_of = [&](const PlanePoint& point) {
        return PlanePoint{frame.left + layout.x.share(point.x) * frame.width(),
                          frame.low + layout.y.share(point.y) * frame.height()};
    };
    const Polyline line = smoothed(series.points, series.along, series.corners);
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (!is_drawn(line[i - 1], panel) || !is_drawn(line[i], panel))
            continue;
        const PlanePoint from = place_of(line[i - 1]), to = place_of(line[i]);
        const double length = std::min(std::hypot(to.x - from.x, to.y - from.y), longest_line);
        const auto steps = static_cast<std::size_t>(length / (square_side / 2)) + 1;
        for (std::size_t k = 0; k < steps; ++k) {
            const double part = static_cast<double>(k) / static_cast<double>(steps);
            const PlanePoint here{from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
            if (frame.holds(here))
                visit(here);
        }
    }
}

} // namespace

std::vector<std::size_t> covering_lines(const FigurePanel& panel, const PanelLayout& layout) {
    std::vector<std::size_t> colours; // in the order in which they are drawn last
    std::map<std::size_t, Squares> squares;
    for (const FigureSeries& series : panel.series) {
        if (!is_line(series) || series.points.empty())
            continue;
        std::erase(colours, series.colour);
        colours.push_back(series.colour);
        walk(series, panel, layout, [&](const PlanePoint& here) { squares[series.colour].insert(square_at(here)); });
    }
    std::map<std::size_t, std::size_t> covering;
    for (std::size_t below = 0; below < colours.size(); ++below)
        for (std::size_t above = below + 1; above < colours.size(); ++above) {
            const Squares& over = squares[colours[above]];
            const auto is_covered = [&](std::uint64_t square) { return over.contains(square); };
            const Squares& under = squares[colours[below]];
            const auto shared = static_cast<double>(std::count_if(under.begin(), under.end(), is_covered));
            if (shared * square_side > least_common_length &&
                shared > covered_share * static_cast<double>(under.size()))
                ++covering[colours[below]];
        }
    std::vector<std::size_t> counts;
    for (const FigureSeries& series : panel.series)
        counts.push_back(is_line(series) ? std::min(covering[series.colour], most_layers) : 0);
    return counts;
}

} // namespace graze
