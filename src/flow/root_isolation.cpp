#include "root_isolation.hpp"

#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace graze {

using bernstein::unit_roundoff;
using roots::evaluate;
using roots::PointValue;
using roots::refine;
using roots::Tracker;

namespace {

constexpr double least_leading_width = 0x1p-64; ///< for parts that begin at 0
constexpr double least_relative_width = 4 * unit_roundoff;
constexpr int parts_per_degree = 64; ///< bounds the work on polynomials that round-off makes undecidable

} // namespace

RootFinder::Isolation::Isolation(RootFinder& finder, std::span<const double> c, double length, RootStart start)
    : finder_(finder), length_(length) {
    if (c.size() > finder.power_.size())
        throw InputError("polynomial of degree " + std::to_string(c.size() - 1) +
                             " given to a root finder for degree " + std::to_string(finder.highest_degree_),
                         "construct it for the highest degree that occurs");
    if (!(length > 0) || !(length < infinity) || c.empty())
        return;
    std::copy(c.begin(), c.end(), finder.power_.begin());
    if (start == RootStart::deflate)
        finder.power_[0] = 0;
    load(c.size());
}

void RootFinder::Isolation::load(std::size_t size) {
    std::span<BernsteinCoefficient> b{finder_.coefficients_.get(), size};
    double power = 1, sum = 0;
    std::size_t used = 0;
    zeros_ = size;
    for (std::size_t k = 0; k < size; ++k) {
        const double scaled = finder_.power_[k] == 0 ? 0 : finder_.power_[k] * power;
        b[k] = {scaled, std::abs(scaled)};
        sum += b[k].bound;
        power *= length_;
        if (scaled != 0) {
            used = k + 1;
            zeros_ = std::min(zeros_, k);
        }
    }
    if (!(sum > 0) || !(sum < infinity))
        return;
    usable_ = true;
    power_ = {finder_.power_.data(), used};
    finder_.find_reciprocals();
    reciprocals_ = {finder_.reciprocals_.data() + used * (used - 1) / 2, used};
    bernstein::from_power(row(0), reciprocals_);
    // Uncertainties: powers k u, coefficients 4 u, conversion (n + 2) u; together at most 2 n + 8.
    first_scale_ = round_off(2) + 6 * unit_roundoff;
    finder_.stack_.clear();
    finder_.stack_.push_back({0, 1, first_scale_, 0});
}

void RootFinder::Isolation::prepare_slope() {
    if (slope_ready_)
        return;
    slope_ready_ = true;
    for (std::size_t k = 1; k < power_.size(); ++k)
        finder_.slope_[k - 1] = static_cast<double>(k) * power_[k];
    slope_ = {finder_.slope_.data(), power_.size() - 1};
    while (slope_zeros_ + 1 < slope_.size() && slope_[slope_zeros_] == 0)
        ++slope_zeros_;
    slope_ = slope_.subspan(slope_zeros_);
}

/// @return whether the derivative (with its roots at 0 divided out) changes sign between the ends
bool RootFinder::Isolation::locate_extremum(const Node& node, std::span<const BernsteinCoefficient> b, double& at,
                                            bool& is_minimum) {
    prepare_slope();
    const double left = place(node.left), right = place(node.left + node.width);
    const double at_left = evaluate_polynomial(slope_, left), at_right = evaluate_polynomial(slope_, right);
    if (!((at_left < 0 && at_right >= 0) || (at_left > 0 && at_right <= 0)))
        return false;
    is_minimum = at_left < 0;
    at = at_right == 0 ? right : refine(slope_, left, right, is_minimum ? -1 : 1, slope_polygon_root(node, b));
    return true;
}

/// Returns where the control polygon first changes sign: an estimate of the root of a part that has one.
double RootFinder::Isolation::control_polygon_root(const Node& node, std::span<const BernsteinCoefficient> b) const {
    std::size_t i = zeros_ > 0 && node.left == 0 ? 1 : 0;
    while (i + 1 < b.size() && (b[i].value > 0) == (b[i + 1].value > 0))
        ++i;
    if (i + 1 >= b.size())
        return place(node.left + 0.5 * node.width);
    const double fraction = b[i].value / (b[i].value - b[i + 1].value);
    return place(node.left + node.width * (static_cast<double>(i) + fraction) / static_cast<double>(b.size() - 1));
}

double RootFinder::Isolation::slope_polygon_root(const Node& node, std::span<const BernsteinCoefficient> b) const {
    if (b.size() < 3)
        return place(node.left + 0.5 * node.width);
    double last = b[1].value - b[0].value;
    for (std::size_t i = 1; i + 1 < b.size(); ++i) {
        const double next = b[i + 1].value - b[i].value;
        if ((last > 0) != (next > 0))
            return place(node.left + node.width * (static_cast<double>(i) - 1 + last / (last - next)) /
                                         static_cast<double>(b.size() - 2));
        last = next;
    }
    return place(node.left + 0.5 * node.width);
}

/// Samples a part with at most one root, or (if `extremum`) at most one extremum, or none distinguishable from
/// round-off.
bool RootFinder::Isolation::leaf(Tracker& tracker, const Node& node, std::span<const BernsteinCoefficient> b,
                                 bool extremum) {
    const double left = place(node.left), right = place(node.left + node.width);
    // A coefficient at an end is the value there; if its sign is certain, it must not be replaced by an uncertain
    // sample.
    const auto sample_end = [&](double s, const BernsteinCoefficient& value, double guess) {
        const double uncertainty = node.scale * value.bound + node.floor;
        return std::abs(value.value) > uncertainty ? tracker.certain(s, value.value > 0 ? 1 : -1, guess)
                                                   : tracker.sample(s, evaluate(power_, s), false, guess);
    };
    if (left > 0 && !sample_end(left, b.front(), 0.5 * left))
        return false;
    double at = 0;
    bool is_minimum = false;
    if (!extremum || !locate_extremum(node, b, at, is_minimum))
        return sample_end(right, b.back(), control_polygon_root(node, b));
    // Near a double root, the parabola at `at` gives estimates of both roots.
    const PointValue point = evaluate(power_, at);
    double curvature = evaluate_derivative(slope_, at);
    for (std::size_t k = 0; k < slope_zeros_; ++k)
        curvature *= at;
    const double distance = std::sqrt(std::abs(2 * point.value / curvature));
    return tracker.sample(at, point, is_minimum, at - distance) && sample_end(right, b.back(), at + distance);
}

bool RootFinder::Isolation::definite(Tracker& tracker, const Node& node, int sign) {
    const double left = place(node.left);
    return (left == 0 || tracker.certain(left, sign, 0.5 * left)) &&
           tracker.certain(place(node.left + node.width), sign, left);
}

/// Recomputes the coefficients of a part if that can sharpen them. @return whether it has
bool RootFinder::Isolation::renew(Node& node, std::span<BernsteinCoefficient> b) {
    if (is_fresh(node))
        return false;
    const double left = place(node.left), right = place(node.left + node.width);
    const double error = evaluate(power_, right).value_error;
    bernstein::expand(power_, left, right - left, error, reciprocals_, b);
    node.scale = first_scale_;
    node.floor = error;
    return true;
}

/// Replaces the part on top of the stack by its halves, or by itself with sharper coefficients.
/// @return false if it is too short or its coefficients cannot become sharper
bool RootFinder::Isolation::split(const bernstein::Range& range) {
    const std::size_t top = finder_.stack_.size() - 1;
    Node& node = finder_.stack_.back();
    const bool leading = node.left == 0 && zeros_ > 0; // bounds are relative there and cannot be sharpened
    // Values that differ by little more than their uncertainty are recomputed; recomputed ones need a smaller
    // difference.
    const double flat = is_fresh(node) ? 3 : 16;
    if (range.high - range.low <= flat * range.uncertainty && !leading)
        return renew(node, row(top));
    const double half = 0.5 * node.width;
    const bool room =
        node.left == 0 ? half >= least_leading_width : half > least_relative_width * (node.left + node.width);
    if (!room || finder_.stack_.size() + 1 >= stack_rows)
        return false;
    bernstein::halve(row(top), row(top + 1));
    node.scale += round_off(1);
    Node left = node;
    left.width = half;
    node.left += half;
    node.width = half;
    finder_.stack_.push_back(left);
    return true;
}

bool RootFinder::Isolation::scan(Tracker& tracker) {
    int parts_left = parts_per_degree * static_cast<int>(power_.size());
    const bool wants_minima = tracker.touches && tracker.touch > 0;
    const double above = wants_minima ? tracker.touch : 0;
    while (!finder_.stack_.empty()) {
        const std::size_t top = finder_.stack_.size() - 1;
        const Node node = finder_.stack_[top];
        const std::span<const BernsteinCoefficient> b = row(top);
        const bernstein::Range range = bernstein::range(b, node.scale, node.floor);
        bool go_on = true;
        if (range.low > above || range.high < 0)
            go_on = definite(tracker, node, range.low > above ? 1 : -1);
        else if (!wants_minima && bernstein::root_variations(b, node.scale, node.floor) < 2)
            go_on = leaf(tracker, node, b, false);
        else if (bernstein::extremum_variations(b, node.scale) < 2)
            go_on = leaf(tracker, node, b, true);
        else if (--parts_left > 0 && split(range))
            continue;
        else
            go_on = leaf(tracker, node, b, true);
        if (!go_on)
            return false;
        finder_.stack_.pop_back();
    }
    return tracker.finish(length_);
}

/// Returns a lower bound around a sample of a part with at most one extremum. It covers the range where the
/// derivative's sign is uncertain; beyond it, the part is monotone up to its next sample.
double RootFinder::Isolation::lower_bound_near(double at, const PointValue& point, double left, double right) {
    if (point.slope_sign() != 0)
        return point.value - point.value_error;
    const auto reach = [&](double direction, double limit) {
        double width = 8 * unit_roundoff * std::max(at, right - left);
        while (width < std::abs(limit - at)) {
            if (evaluate(power_, at + direction * width).slope_sign() != 0)
                return at + direction * width;
            width *= 8;
        }
        return limit;
    };
    const double from = reach(-1, left), to = reach(1, right);
    const double error = evaluate(power_, to).value_error;
    const std::span<BernsteinCoefficient> spare = row(stack_rows);
    // The width is rounded up: the window may grow but not shrink.
    bernstein::expand(power_, from, (to - from) * (1 + 4 * unit_roundoff), error, reciprocals_, spare);
    return std::min(point.value - point.value_error, bernstein::range(spare, first_scale_, error).low);
}

Minimum RootFinder::Isolation::minimum() {
    int parts_left = parts_per_degree * static_cast<int>(power_.size());
    Minimum best{0, infinity, infinity};
    const auto add = [&](double at, const PointValue& point, double bound) {
        if (point.value < best.value) {
            best.at = at;
            best.value = point.value;
        }
        best.lower_bound = std::min(best.lower_bound, bound);
    };
    for (const double end : {0.0, length_}) {
        const PointValue point = evaluate(power_, end);
        add(end, point, point.value - point.value_error);
    }
    while (!finder_.stack_.empty()) {
        const std::size_t top = finder_.stack_.size() - 1;
        const Node node = finder_.stack_[top];
        const std::span<const BernsteinCoefficient> b = row(top);
        const bernstein::Range range = bernstein::range(b, node.scale, node.floor);
        const double left = place(node.left), right = place(node.left + node.width);
        if (range.low >= best.value) {
            finder_.stack_.pop_back();
            continue;
        }
        const bool one_extremum = bernstein::extremum_variations(b, node.scale) < 2;
        if (!one_extremum && --parts_left > 0 && split(range))
            continue;
        double at = 0;
        bool is_minimum = false;
        const auto add_sample = [&](double s) {
            const PointValue point = evaluate(power_, s);
            add(s, point, one_extremum ? lower_bound_near(s, point, left, right) : range.low);
        };
        add_sample(left);
        if (locate_extremum(node, b, at, is_minimum))
            add_sample(at);
        add_sample(right);
        finder_.stack_.pop_back();
    }
    return best;
}

} // namespace graze
