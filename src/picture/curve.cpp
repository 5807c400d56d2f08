#include "picture/curve.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "picture/box.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace graze {

namespace {

/// Distance of p from the segment between a and b.
double distance_from(PlanePoint p, PlanePoint a, PlanePoint b) {
    const double dx = b.x - a.x, dy = b.y - a.y;
    const double square = dx * dx + dy * dy;
    double share = square > 0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / square : 0;
    share = std::clamp(share, 0.0, 1.0);
    return std::hypot(p.x - a.x - share * dx, p.y - a.y - share * dy);
}

/// Slope of the cubics at a point between two intervals with these lengths and slopes; zero at extrema.
double slope_between(double length, double slope, double next_length, double next_slope) {
    if (slope * next_slope <= 0)
        return 0;
    const double one = 2 * next_length + length, other = next_length + 2 * length;
    return (one + other) / (one / slope + other / next_slope);
}

/// Slope at an end: that of the parabola through three points, limited so that the cubic is monotone.
double slope_at_end(double length, double slope, double next_length, double next_slope) {
    const double parabola = ((2 * length + next_length) * slope - length * next_slope) / (length + next_length);
    if (parabola * slope <= 0)
        return 0;
    constexpr double steepest = 3; // beyond, the cubic would overshoot (Fritsch and Carlson 1980)
    return slope * next_slope < 0 && std::abs(parabola) > steepest * std::abs(slope) ? steepest * slope : parabola;
}

/// Adds the cubics of a piece without corners. @param along strictly increasing
void add_smoothed(Polyline& result, std::span<const PlanePoint> line, std::span<const double> along) {
    constexpr int parts = 8; // of each interval
    const std::size_t count = line.size();
    std::vector<PlanePoint> chords(count), slopes(count);
    for (std::size_t i = 0; i + 1 < count; ++i) {
        const double length = along[i + 1] - along[i];
        chords[i] = {(line[i + 1].x - line[i].x) / length, (line[i + 1].y - line[i].y) / length};
    }
    slopes[0] = chords[0];
    slopes[count - 1] = chords[count - 2];
    if (count > 2) {
        const auto at_end = [&](std::size_t i, std::size_t k, double length, double next) {
            return PlanePoint{slope_at_end(length, chords[i].x, next, chords[k].x),
                              slope_at_end(length, chords[i].y, next, chords[k].y)};
        };
        slopes[0] = at_end(0, 1, along[1] - along[0], along[2] - along[1]);
        slopes[count - 1] =
            at_end(count - 2, count - 3, along[count - 1] - along[count - 2], along[count - 2] - along[count - 3]);
    }
    for (std::size_t i = 1; i + 1 < count; ++i) {
        const double length = along[i] - along[i - 1], next = along[i + 1] - along[i];
        slopes[i] = {slope_between(length, chords[i - 1].x, next, chords[i].x),
                     slope_between(length, chords[i - 1].y, next, chords[i].y)};
    }
    for (std::size_t i = 0; i + 1 < count; ++i) {
        const double length = along[i + 1] - along[i];
        for (int part = 1; part <= parts; ++part) {
            const double t = static_cast<double>(part) / parts, u = 1 - t;
            const auto cubic = [&](double PlanePoint::*c) {
                return u * u * (1 + 2 * t) * line[i].*c + t * t * (1 + 2 * u) * line[i + 1].*c +
                       length * t * u * (u * slopes[i].*c - t * slopes[i + 1].*c);
            };
            result.push_back(part == parts ? line[i + 1] : PlanePoint{cubic(&PlanePoint::x), cubic(&PlanePoint::y)});
        }
    }
}

/// The next number 1, 2 or 5 times a power of ten that is not below the step.
double round_step(double step) {
    const double decade = std::pow(10.0, std::floor(std::log10(step)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (step <= factor * decade * (1 + 1e-12))
            return factor * decade;
    return 10 * decade;
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

Polyline smoothed(std::span<const PlanePoint> line, std::span<const double> along,
                  std::span<const std::size_t> corners) {
    if (line.empty() || along.size() != line.size())
        return {line.begin(), line.end()};
    const auto is_whole = [&](std::size_t i) { // the interval after point i can be smoothed
        return std::isfinite(line[i].x) && std::isfinite(line[i].y) && std::isfinite(line[i + 1].x) &&
               std::isfinite(line[i + 1].y) && along[i + 1] > along[i];
    };
    Polyline result{line[0]};
    for (std::size_t first = 0; first + 1 < line.size();) {
        std::size_t last = first + 1;
        if (!is_whole(first)) {
            result.push_back(line[last]);
            first = last;
            continue;
        }
        while (last + 1 < line.size() && is_whole(last) &&
               std::find(corners.begin(), corners.end(), last) == corners.end())
            ++last;
        add_smoothed(result, line.subspan(first, last - first + 1), along.subspan(first, last - first + 1));
        first = last;
    }
    return result;
}

bool wraps_around(double from, double to, double period) {
    return period > 0 && std::abs(to - from) > period / 2;
}

std::vector<PlanePoint> curve_of(const DenseMotion& motion, std::size_t x, std::size_t y) {
    const std::vector<double>&xs = motion.values[x], &ys = motion.values[y];
    std::vector<PlanePoint> points;
    std::size_t arc = 0;
    for (std::size_t i = 0; i < xs.size(); ++i) {
        const bool begins = arc < motion.begins.size() && motion.begins[arc] == i;
        arc += begins ? 1 : 0;
        if (i > 0 && (begins || wraps_around(xs[i - 1], xs[i], motion.periods[x]) ||
                      wraps_around(ys[i - 1], ys[i], motion.periods[y])))
            points.push_back({not_a_number, not_a_number});
        points.push_back({xs[i], ys[i]});
    }
    return points;
}

std::vector<double> contour_levels(const ContourGrid& grid, std::size_t about) {
    Extent range;
    for (const double value : grid.values)
        if (std::isfinite(value))
            range.add(value);
    const auto [least, greatest] = range;
    std::vector<double> levels;
    if (!(least < greatest) || about == 0)
        return levels;
    const double step = round_step((greatest - least) / static_cast<double>(about));
    // Levels are multiples of the step. Rounding may leave none between values that are large and nearly equal.
    const double first = std::ceil(least / step), last = std::floor(greatest / step);
    // The loop is bounded: for large values, adding 1 may not change `first`.
    for (std::size_t k = 0; k <= 2 * about + 2 && first + static_cast<double>(k) <= last; ++k)
        if (const double level = (first + static_cast<double>(k)) * step; level > least && level < greatest)
            if (levels.empty() || level > levels.back())
                levels.push_back(level);
    return levels;
}

std::vector<PlanePoint> contour_line(const ContourGrid& grid, double level) {
    const std::size_t across = grid.x.size();
    std::vector<PlanePoint> points;
    for (std::size_t j = 0; j + 1 < grid.y.size(); ++j)
        for (std::size_t i = 0; i + 1 < across; ++i) {
            const std::array<PlanePoint, 4> corners{{{grid.x[i], grid.y[j]},
                                                     {grid.x[i + 1], grid.y[j]},
                                                     {grid.x[i + 1], grid.y[j + 1]},
                                                     {grid.x[i], grid.y[j + 1]}}};
            const std::array<double, 4> values{grid.values[j * across + i], grid.values[j * across + i + 1],
                                               grid.values[(j + 1) * across + i + 1],
                                               grid.values[(j + 1) * across + i]};
            if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
                continue;
            std::vector<PlanePoint> crossings;
            for (std::size_t k = 0; k < corners.size(); ++k) {
                const std::size_t next = (k + 1) % corners.size();
                if ((values[k] < level) == (values[next] < level))
                    continue;
                const double share = (level - values[k]) / (values[next] - values[k]);
                crossings.push_back(between(corners[k], corners[next], share));
            }
            // Two crossings, or four at a saddle, where either pairing is valid.
            for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
                points.insert(points.end(), {crossings[k], crossings[k + 1], {not_a_number, not_a_number}});
        }
    return points;
}

void require_drawable(double low, double high, const std::string& name) {
    const double size = std::max(std::abs(low), std::abs(high));
    constexpr double largest = 1e280, smallest = 1e-280; // squares of ratios neither overflow nor vanish
    if (!(size >= smallest && size <= largest && high > low))
        throw InputError(fmt::format("the axis '{}' from {:.3g} to {:.3g} cannot be drawn", name, low, high),
                         fmt::format("draw numbers between {:g} and {:g}, in another unit", smallest, largest));
}

Axis axis_for(double least, double greatest, int tics, double margin) {
    if (!(least <= greatest))
        return {};
    double span = greatest - least;
    const double size = std::max(std::abs(least), std::abs(greatest));
    if (span <= 1e-9 * size || span == 0) { // a constant value lies in the middle of the axis
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
