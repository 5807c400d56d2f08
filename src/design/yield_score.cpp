#include "design/yield_score.hpp"

#include <cmath>
#include <numbers>

namespace graze {

namespace {

/// Logarithm of the upper tail of the normal distribution beyond x.
double log_tail(double x) {
    constexpr double far = 25; // the next term of the asymptotic series is 15/x^6, below 1e-7 of a logarithm of -300
    if (x < far)
        return std::log(0.5 * std::erfc(x / std::numbers::sqrt2));
    const double square = x * x;
    return -0.5 * square - std::log(x * std::sqrt(2 * std::numbers::pi)) + std::log1p((-1 + 3 / square) / square);
}

/// Inverts log_tail. @param logarithm of a share of at most a half. @return the x beyond which that share lies
double tail_of(double logarithm) {
    double x = std::sqrt(std::fmax(0, -2 * logarithm)) / 2;
    constexpr int most = 60; // Newton's method on a concave function
    for (int i = 0; i < most; ++i) {
        const double there = log_tail(x);
        const double slope = -std::exp(-0.5 * x * x - 0.5 * std::log(2 * std::numbers::pi) - there);
        const double next = x - (there - logarithm) / slope;
        if (next == x)
            break;
        x = next;
    }
    return x;
}

} // namespace

double yield_score(double least, double greatest, double value, double deviation) {
    const double low = (least - value) / deviation, high = (greatest - value) / deviation;
    const double outside = std::exp(log_tail(-low)) + std::exp(log_tail(high));
    if (outside <= 0.5)
        // The larger tail may underflow.
        return outside > 1e-290 ? tail_of(std::log(outside)) : std::fmin(-low, high);
    if (low < 0 && high > 0)
        return -tail_of(std::log1p(-outside));
    const double near = low >= 0 ? low : -high, far = low >= 0 ? high : -low;
    const double at_near = log_tail(near);
    const double inside = at_near + std::log1p(-std::exp(log_tail(far) - at_near));
    return std::isfinite(inside) ? -tail_of(inside) : -near;
}

double score_of_share(double share) {
    return share < 0.5 ? -tail_of(std::log(share)) : tail_of(std::log1p(-share));
}

YieldSettings yield_settings_of(const Design& design, const Orbit& orbit) {
    YieldSettings settings;
    for (const DesignDimension& one : design.dimensions)
        if (one.tolerance)
            settings.tolerances.push_back(one.tolerance->at(one.parameter, orbit.parameters[one.parameter.place()]));
    settings.devices = design.yield.devices;
    settings.seed = design.yield.seed;
    settings.least = design.least_usable();
    settings.greatest = design.greatest_usable();
    return settings;
}

} // namespace graze
