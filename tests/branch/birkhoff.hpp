// Rotation numbers from motions alone, independent of the equations of tori.

#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <utility>

namespace graze::testing {

/// Returns the rotation number of a motion about a centre, in turns per return: the mean of its turns, weighted by a
/// smooth bump, with which it converges faster than any power of their number (S. Das, Y. Saiki, E. Sander and J. A.
/// Yorke, Nonlinearity 30, 2017). Turns are counted from 0 to 1.
/// @param next gives the coordinates, relative to the centre, of one return after the other
inline double rotation_number(const std::function<std::pair<double, double>()>& next, std::size_t returns) {
    double sum = 0, weights = 0;
    const auto angle_of = [](const std::pair<double, double>& point) {
        return std::atan2(point.second, point.first) / (2 * std::numbers::pi);
    };
    double before = angle_of(next());
    for (std::size_t n = 0; n < returns; ++n) {
        const double angle = angle_of(next()), turned = angle - before - std::floor(angle - before);
        const double at = (static_cast<double>(n) + 1) / (static_cast<double>(returns) + 1);
        const double weight = std::exp(-1 / (at * (1 - at)));
        sum += weight * turned;
        weights += weight;
        before = angle;
    }
    return sum / weights;
}

} // namespace graze::testing
