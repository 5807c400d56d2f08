#include "picture/page_line.hpp"

#include "picture/figure_look.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_set>

namespace graze {

namespace {

/// Collects the dashes of a line; a dash may continue from one segment of the line to the next.
class Dashes {
public:
    explicit Dashes(const DashPattern& pattern) : pattern_(pattern) {}

    void add(const PlanePoint& from, const PlanePoint& to) {
        const double dx = to.x - from.x, dy = to.y - from.y;
        const bool level = std::abs(dx) >= std::abs(dy);
        const double start = level ? from.x : from.y, size = level ? dx : dy;
        if (size == 0)
            return;
        double part = 0;
        while (part < 1) {
            const double place = start + part * size;
            const bool ahead = size > 0;
            const double next = edge_beyond(place, ahead);
            const double end = std::min(1.0, (next - start) / size);
            if (!(end > part)) // the edge coincides up to rounding
                break;
            const double middle = start + (part + end) / 2 * size;
            if (phase(middle) < pattern_.dash)
                draw(between(from, to, part), between(from, to, end));
            else
                finish();
            part = end;
        }
    }
    void finish() {
        if (dash_.size() > 1)
            dashes_.push_back(std::move(dash_));
        dash_.clear();
    }
    std::vector<Polyline> take() {
        finish();
        return std::move(dashes_);
    }

private:
    double phase(double place) const { return place - std::floor(place / pattern_.length()) * pattern_.length(); }
    /// The next edge of a dash or gap. @param ahead in the direction of increasing coordinate
    double edge_beyond(double place, bool ahead) const {
        const double tiny = 1e-9 * pattern_.length();
        const double first = std::floor(place / pattern_.length()) * pattern_.length();
        const double edges[] = {first - pattern_.gap, first, first + pattern_.dash, first + pattern_.length(),
                                first + pattern_.length() + pattern_.dash};
        double best = ahead ? edges[4] : edges[0];
        for (const double edge : edges)
            if (ahead ? edge > place + tiny && edge < best : edge < place - tiny && edge > best)
                best = edge;
        return best;
    }
    void draw(const PlanePoint& from, const PlanePoint& to) {
        if (dash_.empty())
            dash_.push_back(from);
        dash_.push_back(to);
    }

    DashPattern pattern_;
    Polyline dash_;
    std::vector<Polyline> dashes_;
};

constexpr double square_side = 0.4; ///< side of a square in points; lines that are further apart are both visible
constexpr double least_common_length = 30; ///< least common length in points of covered lines; crossings are shorter
constexpr double covered_share = 0.7;      ///< least covered fraction of a line; otherwise enough of it is visible
constexpr std::size_t most_layers = 2;
constexpr double longest_line = 1e5; ///< points; limits the work for lines that leave the page

using Squares = std::unordered_set<std::uint64_t>;

/// The square of a point of the page; coordinates are not negative.
std::uint64_t square_at(const PlanePoint& point) {
    return static_cast<std::uint64_t>(point.x / square_side) << 32 | static_cast<std::uint64_t>(point.y / square_side);
}

/// Calls `visit` with points of a line in the frame, at most half a square apart.
template <class Visit>
void walk(const FigureSeries& series, const FigurePanel& panel, const PanelLayout& layout, Visit visit) {
    const Polyline line = smoothed(series.points, series.along, series.corners);
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (!is_drawn(line[i - 1], panel) || !is_drawn(line[i], panel))
            continue;
        const PlanePoint from = on_page(line[i - 1], layout), to = on_page(line[i], layout);
        const double length = std::min(distance_of(from, to), longest_line);
        const auto steps = static_cast<std::size_t>(length / (square_side / 2)) + 1;
        for (std::size_t k = 0; k < steps; ++k)
            if (const PlanePoint here = between(from, to, static_cast<double>(k) / static_cast<double>(steps));
                layout.frame.holds(here))
                visit(here);
    }
}

} // namespace

PlanePoint on_page(const PlanePoint& point, const PanelLayout& layout) {
    const Box& frame = layout.frame;
    return {frame.left + layout.x.share(point.x) * frame.width(), frame.low + layout.y.share(point.y) * frame.height()};
}

PlanePoint off_page(const PlanePoint& point, const PanelLayout& layout) {
    const Box& frame = layout.frame;
    return {layout.x.value_at((point.x - frame.left) / frame.width()),
            layout.y.value_at((point.y - frame.low) / frame.height())};
}

DashPattern dash_pattern(FigureSeries::Style style, double stroke) {
    return style == FigureSeries::Style::dotted ? DashPattern{1.05 * stroke, 2.05 * stroke}
                                                : DashPattern{4 * stroke, 2.2 * stroke};
}

std::vector<Polyline> dashes_of(const Polyline& line, const DashPattern& pattern, const Box& frame) {
    Dashes dashes(pattern);
    for (std::size_t i = 1; i < line.size(); ++i) {
        const auto seen = part_within(line[i - 1], line[i], frame);
        if (!seen || seen->first > 0)
            dashes.finish();
        if (seen)
            dashes.add(between(line[i - 1], line[i], seen->first), between(line[i - 1], line[i], seen->second));
    }
    return dashes.take();
}

std::vector<PlanePoint> spread_along(const Polyline& line, double distance, double first, const Box& frame) {
    std::vector<PlanePoint> points;
    double next = first, walked = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const auto seen = part_within(line[i - 1], line[i], frame);
        if (!seen)
            continue;
        const PlanePoint from = between(line[i - 1], line[i], seen->first),
                         to = between(line[i - 1], line[i], seen->second);
        const double length = distance_of(from, to);
        for (; next <= walked + length; next += distance)
            points.push_back(between(from, to, length > 0 ? (next - walked) / length : 0));
        walked += length;
    }
    return points;
}

std::vector<std::size_t> covering_lines(const FigurePanel& panel, const PanelLayout& layout) {
    std::vector<std::size_t> colours; // in the order in which they are drawn last
    std::map<std::size_t, Squares> squares;
    for (const FigureSeries& series : panel.series) {
        if (!is_line(series.style) || series.points.empty())
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
        counts.push_back(is_line(series.style) ? std::min(covering[series.colour], most_layers) : 0);
    return counts;
}

} // namespace graze
