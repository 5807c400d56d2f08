#include "picture/interleaved_points.hpp"

#include "base/random_number.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace graze {

namespace {

/// Dots of a series that are closer than this fraction of the panel are merged.
constexpr double grain = 1.0 / 2000;
constexpr double dot_size = 1.2; ///< points

struct Dot {
    std::uint64_t square = 0; ///< square of about the size of a dot
    std::uint64_t order = 0;
    bool on_top = false;
    InterleavedDot drawn;
};

std::uint64_t cell(double column, double row) {
    return static_cast<std::uint64_t>(column) << 32 | static_cast<std::uint64_t>(row);
}

/// Sorts the dots so that in each square a pseudo-randomly chosen series is drawn last.
void interleave(std::vector<Dot>& dots) {
    std::map<std::uint64_t, std::set<std::size_t>> present;
    for (const Dot& dot : dots)
        present[dot.square].insert(dot.drawn.series);
    for (Dot& dot : dots) {
        const std::set<std::size_t>& there = present[dot.square];
        const auto top = static_cast<std::ptrdiff_t>(mixed(dot.square) % there.size());
        dot.on_top = *std::next(there.begin(), top) == dot.drawn.series;
    }
    std::stable_sort(dots.begin(), dots.end(), [](const Dot& a, const Dot& b) {
        return std::pair(a.on_top, a.order) < std::pair(b.on_top, b.order);
    });
}

constexpr double width_of_column = 0.42; ///< points
/// Slant of strokes in points: viewers align exactly vertical lines with pixels, which makes thin curves jagged.
constexpr double slant = 0.06;
constexpr double joining_distance = 1; ///< greatest vertical distance of joined dots, in widths
/// Extension of a stroke beyond the centre of its last dot, in widths: pi/8, so that a single dot keeps its area.
constexpr double reach_of_dot = 0.39;
constexpr std::size_t stroke_layers = 6;

/// A dot on the page, in points from the lower left corner of the frame.
struct PageDot {
    double x = 0, y = 0;
    std::size_t series = 0;
    std::uint64_t column() const { return static_cast<std::uint64_t>(x / width_of_column); }
};

/// The last dot in each small square, which covers the others; sorted by columns, then upwards.
std::vector<PageDot> seen_dots(std::span<const InterleavedDot> dots, const PanelLayout& layout) {
    std::unordered_map<std::uint64_t, PageDot> squares;
    for (const InterleavedDot& dot : dots) {
        const PageDot here{layout.x.share(dot.at.x) * layout.frame.width(),
                           layout.y.share(dot.at.y) * layout.frame.height(), dot.series};
        squares[cell(here.x / width_of_column, here.y / width_of_column)] = here;
    }
    std::vector<PageDot> seen;
    seen.reserve(squares.size());
    for (const auto& [square, dot] : squares)
        seen.push_back(dot);
    std::sort(seen.begin(), seen.end(), [](const PageDot& a, const PageDot& b) {
        return std::pair(a.column(), a.y) < std::pair(b.column(), b.y);
    });
    return seen;
}

bool has_crosses(const FigureSeries& series) {
    constexpr int upright = 1, oblique = 2; // gnuplot's
    return series.style == FigureSeries::Style::symbols && (series.symbol == upright || series.symbol == oblique);
}

} // namespace

std::vector<InterleavedDot> interleaved_dots(const FigurePanel& panel, const PanelLayout& layout) {
    std::vector<Dot> dots;
    for (std::size_t s = 0; s < panel.series.size(); ++s) {
        const FigureSeries& series = panel.series[s];
        if (series.style != FigureSeries::Style::dots)
            continue;
        std::unordered_set<std::uint64_t> taken;
        for (const PlanePoint& point : series.points) {
            const double x = layout.x.share(point.x), y = layout.y.share(point.y);
            if (!is_drawn(point, panel) || !(x >= 0 && x <= 1 && y >= 0 && y <= 1))
                continue;
            const std::uint64_t place = cell(x / grain, y / grain);
            const std::uint64_t square =
                cell(x * layout.frame.width() / dot_size, y * layout.frame.height() / dot_size);
            if (taken.insert(place).second)
                dots.push_back({square, mixed(place * 31 + s), false, {point, s}});
        }
    }
    interleave(dots);
    std::vector<InterleavedDot> drawn;
    for (const Dot& dot : dots)
        drawn.push_back(dot.drawn);
    return drawn;
}

std::vector<DotStroke> dot_strokes(std::span<const InterleavedDot> dots, const PanelLayout& layout, double width) {
    const double reach = reach_of_dot * width;
    const std::vector<PageDot> seen = seen_dots(dots, layout);
    std::vector<DotStroke> strokes;
    const auto across = [&](double at) { return layout.x.value_at(at / layout.frame.width()); };
    const auto up = [&](double at) { return layout.y.value_at(at / layout.frame.height()); };
    for (std::size_t first = 0, next = 0; first < seen.size(); first = next) {
        const PageDot& lowest = seen[first];
        double sum = 0;
        do
            sum += seen[next++].x;
        while (next < seen.size() && seen[next].column() == lowest.column() && seen[next].series == lowest.series &&
               seen[next].y - seen[next - 1].y < joining_distance * width);
        const double x = sum / static_cast<double>(next - first);
        const std::uint64_t place = lowest.column() * 1'000'003 + static_cast<std::uint64_t>(lowest.y / 2.4);
        strokes.push_back({{across(x - slant), up(lowest.y - reach)},
                           {across(x + slant), up(seen[next - 1].y + reach)},
                           lowest.series,
                           scrambled(place) % stroke_layers});
    }
    return strokes;
}

std::size_t last_of_crosses(const FigurePanel& panel, std::size_t series) {
    std::size_t last = series;
    while (has_crosses(panel.series[series]) && last + 1 < panel.series.size() && has_crosses(panel.series[last + 1]))
        ++last;
    return last;
}

std::vector<CrossLayer> interleaved_crosses(const FigurePanel& panel, std::size_t first, std::size_t last) {
    const std::size_t count = last - first + 1, layers = 3 * count; // each series is drawn last in three layers
    std::vector<CrossLayer> result;
    for (std::size_t layer = 0; layer < layers; ++layer)
        for (std::size_t turn = 0; turn < count; ++turn) {
            CrossLayer& one = result.emplace_back();
            one.series = first + (layer + turn) % count;
            const std::vector<PlanePoint>& points = panel.series[one.series].points;
            for (std::size_t i = layer; i < points.size(); i += layers)
                one.points.push_back(points[i]);
        }
    return result;
}

} // namespace graze
