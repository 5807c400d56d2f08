#include "root_tracker.hpp"

#include "bernstein.hpp"
#include "number_pair.hpp"

#include <cmath>

namespace graze::roots {

using bernstein::unit_roundoff;

namespace {

constexpr int refinement_steps = 200;

} // namespace

namespace {

/// Sums even and odd terms side by side, in powers of the square: p(s) = e(s^2) + s o(s^2).
/// @param with_errors whether to compute error bounds; otherwise they are 0
template <bool with_errors>
PointValue evaluate_in_pairs(std::span<const double> c, double s) {
    const double square = s * s;
    NumberPair value{}, slope{}, size{}, size_slope{};
    std::size_t k = c.size();
    if (k % 2 == 1) {
        value = NumberPair{c[--k], 0};
        size = absolute(value);
    }
    for (const double* at = c.data() + k; at != c.data();) {
        at -= 2;
        const NumberPair pair = load_pair(at);
        slope = slope * square + value;
        value = value * square + pair;
        if constexpr (with_errors)
            size_slope = size_slope * square + size;
        size = size * square + absolute(pair);
    }
    const double all = size[0] + s * size[1];
    PointValue point{value[0] + s * value[1], value[1] + 2 * s * (slope[0] + s * slope[1]), all, 0, 0};
    if constexpr (with_errors) {
        const double degree = static_cast<double>(c.size()),
                     all_slopes = size[1] + 2 * s * (size_slope[0] + s * size_slope[1]);
        point.value_error = unit_roundoff * (4 * all + 2 * s * all_slopes);
        point.slope_error = unit_roundoff * (2 * degree + 4) * all_slopes;
    }
    return point;
}

} // namespace

PointValue evaluate(std::span<const double> c, double s) {
    return evaluate_in_pairs<true>(c, s);
}

double refine(std::span<const double> c, double low, double high, int sign_low, double guess) {
    double s = guess > low && guess < high ? guess : 0.5 * (low + high);
    double last_step = high - low;
    for (int i = 0; i < refinement_steps; ++i) {
        const PointValue point = evaluate_in_pairs<false>(c, s);
        const double newton = s - point.value / point.slope;
        const bool inside = newton > low && newton < high;
        if (std::abs(point.value) <= unit_roundoff * point.size) // round-off would dominate a longer step
            return inside && std::abs(newton - s) <= 4 * unit_roundoff * s ? newton : s;
        ((point.value > 0) == (sign_low > 0) ? low : high) = s;
        double next = newton;
        if (!(next > low && next < high) || std::abs(next - s) > 0.5 * last_step) {
            // In a wide bracket, halve the exponent rather than the length: a small root needs relative accuracy.
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

/// True when a minimum that has not been reported lies at the end, where the slope is zero up to round-off.
bool Tracker::ends_in_minimum(double length) const {
    double curvature = 0;
    for (std::size_t k = power_.size(); k-- > 2;)
        curvature = curvature * length + static_cast<double>(k * (k - 1)) * power_[k];
    return curvature > 0 && evaluate(power_, 0.5 * (last_touch_ + length)).slope_sign() != 0;
}

} // namespace graze::roots
