#include "picture/dot_strokes.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace graze {

namespace {

constexpr double column_width = 0.42; ///< points
/// Slant of strokes in points: viewers align exactly vertical lines with pixels, which makes thin curves jagged.
constexpr double slant = 0.06;
constexpr double joining_distance = 1; ///< greatest vertical distance of joined dots, in widths
/// Extension of a stroke beyond the centre of its last dot, in widths: pi/8, so that a single dot keeps its area.
constexpr double reach_of_dot = 0.39;

/// A dot on the page, in points from the lower left corner of the frame.
struct PageDot {
    double x = 0, y = 0;
    std::size_t series = 0;
};

struct Run {
    double low = 0, high = 0, sum = 0;
    std::size_t series = 0, dots = 0;
};

/// A pseudo-random layer that is the same in each run (a step of SplitMix64, as in interleaved_dots.cpp).
std::size_t layer_of(std::uint64_t column, double low) {
    std::uint64_t value = column * 1'000'003 + static_cast<std::uint64_t>(low / 2.4);
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
    return static_cast<std::size_t>((value ^ (value >> 31)) % stroke_layers);
}

/// The last dot in each small square, which covers the others; sorted by columns, then upwards.
std::vector<PageDot> seen_dots(std::span<const InterleavedDot> dots, const PanelLayout& layout) {
    std::unordered_map<std::uint64_t, PageDot> squares;
    for (const InterleavedDot& dot : dots) {
        const PageDot here{layout.x.share(dot.at.x) * layout.frame.width(),
                           layout.y.share(dot.at.y) * layout.frame.height(), dot.series};
        const auto column = static_cast<std::uint64_t>(here.x / column_width),
                   row = static_cast<std::uint64_t>(here.y / column_width);
        squares[column << 32 | row] = here;
    }
    std::vector<PageDot> seen;
    seen.reserve(squares.size());
    for (const auto& [square, dot] : squares)
        seen.push_back(dot);
    std::sort(seen.begin(), seen.end(), [](const PageDot& a, const PageDot& b) {
        const auto column = [](const PageDot& dot) { return static_cast<std::uint64_t>(dot.x / column_width); };
        return std::pair(column(a), a.y) < std::pair(column(b), b.y);
    });
    return seen;
}

} // namespace

std::vector<DotStroke> dot_strokes(std::span<const InterleavedDot> dots, const PanelLayout& layout, double width) {
    const double reach = reach_of_dot * width;
    const std::vector<PageDot> seen = seen_dots(dots, layout);
    std::vector<DotStroke> strokes;
    const Box& frame = layout.frame;
    const auto add = [&](std::uint64_t column, const Run& run) {
        const double x = run.sum / static_cast<double>(run.dots);
        const auto across = [&](double at) { return layout.x.value_at(at / frame.width()); };
        strokes.push_back({{across(x - slant), layout.y.value_at((run.low - reach) / frame.height())},
                           {across(x + slant), layout.y.value_at((run.high + reach) / frame.height())},
                           run.series,
                           layer_of(column, run.low)});
    };
    Run run;
    std::uint64_t at = 0;
    for (const PageDot& dot : seen) {
        const auto column = static_cast<std::uint64_t>(dot.x / column_width);
        const bool goes_on =
            run.dots > 0 && column == at && dot.series == run.series && dot.y - run.high < joining_distance * width;
        if (!goes_on && run.dots > 0)
            add(at, run);
        if (!goes_on)
            run = {dot.y, dot.y, 0, dot.series, 0};
        at = column;
        run.high = dot.y;
        run.sum += dot.x;
        ++run.dots;
    }
    if (run.dots > 0)
        add(at, run);
    return strokes;
}

} // namespace graze
