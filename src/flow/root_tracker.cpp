#include "root_tracker.hpp"

#include "bernstein.hpp"

#include <cmath>

namespace graze::roots {

using bernstein::unit_roundoff;

namespace {

constexpr int refinement_steps = 200;

} // namespace

PointValue evaluate(std::span<const double> c, double s) {
    double value = 0, slope = 0, size = 0, size_slope = 0;
#pragma GCC unroll 4
    for (std::size_t k = c.size(); k-- > 0;) {
        slope = slope * s + value;
        value = value * s + c[k];
        size_slope = size_slope * s + size;
        size = size * s + std::abs(c[k]);
    }
    const double degree = static_cast<double>(c.size());
    return {value, slope, size, unit_roundoff * (4 * size + 2 * s * size_slope),
            unit_roundoff * (2 * degree + 4) * size_slope};
}

double refine(std::span<const double> c, double low, double high, int sign_low, double guess) {
    double s = guess > low && guess < high ? guess : 0.5 * (low + high);
    double last_step = high - low;
    for (int i = 0; i < refinement_steps; ++i) {
        const PointValue point = evaluate(c, s);
        const double newton = s - point.value / point.slope;
        const bool inside = newton > low && newton < high;
        if (std::abs(point.value) <= unit_roundoff * point.size) // a longer step would be led by round-off
            return inside && std::abs(newton - s) <= 4 * unit_roundoff * s ? newton : s;
        ((point.value > 0) == (sign_low > 0) ? low : high) = s;
        double next = newton;
        if (!(next > low && next < high) || std::abs(next - s) > 0.5 * last_step) {
            // Halve the exponent of a wide bracket rather than its length: a small root wants relative accuracy.
            next = high > 4 * low && low > 0 ? std::sqrt(low * high) : 0.5 * (low + high);
            if (!(next > low && next < high))
                return s;
        }
        last_step = std::abs(next - s);
        s = next;
        if (last_step <= unit_roundoff * s)
            return s;
    }
    return s;
}

bool Tracker::certain(double at, int sign, double guess) {
    if (sign == sign_)
        report_pending_touch();
    else if (!report_crossing(refine(quotient_, at_, at, sign_, guess)))
        return false;
    pending_ = false;
    at_ = at;
    sign_ = sign;
    return true;
}

bool Tracker::sample(double at, const PointValue& point, bool minimum, double guess) {
    const int sign = point.sign();
    if (sign == 0) {
        if (!pending_ || point.value < pending_touch_.value)
            pending_touch_ = {RootKind::touch, at, point.value};
        pending_ = true;
        return true;
    }
    if (!certain(at, sign, guess))
        return false;
    if (minimum && sign > 0 && point.value <= touch)
        report_touch({RootKind::touch, at, point.value});
    return true;
}

bool Tracker::finish(double length) {
    const PointValue end = evaluate(power_, length);
    if (end.sign() != 0) {
        if (end.sign() > 0 && end.value <= touch && end.slope_sign() == 0 && ends_in_minimum(length))
            report_touch({RootKind::touch, length, end.value});
        return true;
    }
    if (end.slope_sign() != -sign_) {
        report_pending_touch();
        return true;
    }
    const bool passed = end.value * sign_ < 0;
    return report_crossing(passed ? refine(quotient_, at_, length, sign_, length) : length);
}

bool Tracker::report_crossing(double at) {
    const Root root{sign_ > 0 ? RootKind::falling : RootKind::rising, at, evaluate_polynomial(power_, at)};
    if (crossings)
        crossings->push_back(root);
    if (only_first_falling && root.kind == RootKind::falling) {
        first = root;
        return false;
    }
    return true;
}

void Tracker::report_pending_touch() {
    if (pending_ && sign_ > 0)
        report_touch(pending_touch_);
}

void Tracker::report_touch(const Root& root) {
    if (touches)
        touches->push_back(root);
    last_touch_ = root.at;
}

/// Whether a minimum that has not been reported lies at the end, where the slope is zero up to round-off.
bool Tracker::ends_in_minimum(double length) const {
    double curvature = 0;
    for (std::size_t k = power_.size(); k-- > 2;)
        curvature = curvature * length + static_cast<double>(k * (k - 1)) * power_[k];
    return curvature > 0 && evaluate(power_, 0.5 * (last_touch_ + length)).slope_sign() != 0;
}

} // namespace graze::roots
