#include "graze/identify/restitution.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

double variance_at(const ImpactSpeeds& impact, double e) {
    return impact.after_error * impact.after_error + e * e * impact.before_error * impact.before_error;
}

/// Half the derivative of the sum of squared distances by the slope e; zero for the nearest line.
double slope_at(std::span<const ImpactSpeeds> impacts, double e) {
    double sum = 0;
    for (const ImpactSpeeds& one : impacts) {
        const double rest = one.after + e * one.before, variance = variance_at(one, e);
        sum += rest * (one.before * variance - rest * e * one.before_error * one.before_error) / (variance * variance);
    }
    return sum;
}

} // namespace

Restitution restitution(std::span<const ImpactSpeeds> impacts) {
    if (impacts.size() < 2)
        throw InputError("there are too few impacts to determine the restitution's error", "give two or more");
    Restitution result;
    const auto count = static_cast<double>(impacts.size());
    double squares = 0, products = 0;
    for (const ImpactSpeeds& one : impacts) {
        for (const double value : {one.before, one.after, one.before_error, one.after_error})
            require_finite(value, "a velocity of an impact");
        if (one.before == 0 || !(one.before_error >= 0) || !(one.after_error > 0))
            throw InputError("an impact has no velocity, or its errors are not positive",
                             "leave it out, or give errors of one for all");
        result.mean_ratio -= one.after / one.before / count;
        squares += one.before * one.before / variance_at(one, 1);
        products -= one.before * one.after / variance_at(one, 1);
    }
    if (!(products > 0))
        throw InputError("velocities after impacts have the signs of those before",
                         "give velocities relative to the stop");
    // Noise biases a regression to smaller slopes; the root is bracketed above that.
    double low = 0, high = std::max(1.0, 2 * products / squares);
    while (slope_at(impacts, high) < 0 && high < 1e6)
        high *= 2;
    constexpr int steps = 200;
    for (int i = 0; i < steps && high - low > 1e-16 * high; ++i) {
        const double e = 0.5 * (low + high);
        (slope_at(impacts, e) < 0 ? low : high) = e;
    }
    const double e = 0.5 * (low + high);
    double misfit = 0, information = 0;
    for (const ImpactSpeeds& one : impacts) {
        const double rest = one.after + e * one.before, variance = variance_at(one, e);
        result.residuals.push_back(rest);
        misfit += rest * rest / variance;
        // Projection of the impact on the line.
        const double before = one.before - rest * e * one.before_error * one.before_error / variance;
        information += before * before / variance;
    }
    result.coefficient = {e, std::sqrt(misfit / (count - 1) / information), count - 1};
    return result;
}

} // namespace graze
