#include "picture/page_line.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

PlanePoint between(const PlanePoint& from, const PlanePoint& to, double part) {
    return {from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
}

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
        const double length = std::hypot(to.x - from.x, to.y - from.y);
        for (; next <= walked + length; next += distance)
            points.push_back(between(from, to, length > 0 ? (next - walked) / length : 0));
        walked += length;
    }
    return points;
}

} // namespace graze
