#pragma once

#include "base/special_numbers.hpp"
#include "graze/picture/figure.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace graze {

/// A rectangle on the page, in points (1/72 inch) from its lower left corner.
struct Box {
    double left = 0, low = 0, right = 0, high = 0;

    double width() const { return right - left; }
    double height() const { return high - low; }
    bool meets(const Box& other) const {
        return left < other.right && other.left < right && low < other.high && other.low < high;
    }
    bool holds(const PlanePoint& point) const {
        return left <= point.x && point.x <= right && low <= point.y && point.y <= high;
    }
    bool holds(const Box& other) const {
        return left <= other.left && other.right <= right && low <= other.low && other.high <= high;
    }
    Box grown(double by) const { return {left - by, low - by, right + by, high + by}; }
    PlanePoint middle() const { return {(left + right) / 2, (low + high) / 2}; }
    static Box around(const PlanePoint& centre, double width, double height) {
        return {centre.x - width / 2, centre.y - height / 2, centre.x + width / 2, centre.y + height / 2};
    }
};

/// The least and the greatest of some values, which are not finite while there is none.
struct Extent {
    double least = infinity, greatest = -infinity;
    void add(double value) {
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    double span() const { return std::max(greatest - least, 0.0); }
    /// Whether the values are equal up to round-off, or there is none.
    bool is_constant() const {
        constexpr double resolved = 1e-9;
        return !(span() > resolved * std::max(std::abs(least), std::abs(greatest)));
    }
};

/// The point at a fraction of the way from one point to another.
inline PlanePoint between(const PlanePoint& from, const PlanePoint& to, double part) {
    return {from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)};
}

inline double distance_of(const PlanePoint& one, const PlanePoint& other) {
    return std::hypot(other.x - one.x, other.y - one.y);
}

/// The part of a line between two points that lies in a box: fractions of its length at which it enters and leaves, or
/// none (Liang and Barsky 1984).
inline std::optional<std::pair<double, double>> part_within(const PlanePoint& from, const PlanePoint& to,
                                                            const Box& box) {
    double first = 0, last = 1;
    const auto clip = [&](double start, double step, double low, double high) {
        if (step == 0)
            return start >= low && start <= high;
        const double one = (low - start) / step, other = (high - start) / step;
        first = std::max(first, std::min(one, other));
        last = std::min(last, std::max(one, other));
        return first <= last;
    };
    if (clip(from.x, to.x - from.x, box.left, box.right) && clip(from.y, to.y - from.y, box.low, box.high))
        return std::pair(first, last);
    return std::nullopt;
}

} // namespace graze
