#include "picture/interleaved_dots.hpp"

#include "base/random_number.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
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

} // namespace graze
