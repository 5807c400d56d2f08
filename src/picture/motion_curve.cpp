#include "picture/motion_curve.hpp"

#include "base/special_numbers.hpp"

#include <cmath>

namespace graze {

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

} // namespace graze
