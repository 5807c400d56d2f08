#pragma once

#include "graze/study/figure.hpp"

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
    static Box around(const PlanePoint& centre, double width, double height) {
        return {centre.x - width / 2, centre.y - height / 2, centre.x + width / 2, centre.y + height / 2};
    }
};

} // namespace graze
