#include "graze/flow/roots.hpp"

#include "base/special_numbers.hpp"
#include "flow/kept_sign.hpp"
#include "flow/number_pair.hpp"
#include "flow/single_crossing.hpp"
#include "graze/base/input_error.hpp"
#include "root_isolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

using bernstein::unit_roundoff;
using roots::evaluate;
using roots::PointValue;
using roots::Tracker;

namespace {

/// Corrects a root found with c[0] = 0 for the true c[0], if that is well defined.
void restore_start(std::span<const double> c, double length, Root& root) {
    const PointValue before = evaluate(c, root.at);
    const double step = before.value / before.slope;
    if (c[0] == 0 || !(std::abs(step) < 0.1 * root.at))
        return;
    const double at = std::min(root.at - step, length);
    const double value = evaluate_polynomial(c, at);
    if (std::abs(value) < std::abs(before.value))
        root = {root.kind, at, value};
}

/// Returns the constant sign of the second derivative.
roots::Kept kept_bend(std::span<const double> c, double length) {
    return roots::kept_sign(c, 2, length, [](double k) { return k * (k - 1); });
}

/// Bounds the decrease of a polynomial from a point with slope -`slope` over a distance in which its second derivative
/// is at least `bend`.
double fall_beyond(double slope, double bend, double distance) {
    return slope > 0 ? std::min(slope * distance, slope * slope / (2 * bend)) : 0;
}

/// Returns a lower bound in [at - left, at + right] of a polynomial whose second derivative is at least `bend` > 0.
double least_around(const PointValue& point, double bend, double left, double right) {
    const double fall = std::max(fall_beyond(point.slope_error + point.slope, bend, left),
                                 fall_beyond(point.slope_error - point.slope, bend, right));
    return point.value - point.value_error - fall;
}

} // namespace

RootFinder::RootFinder(int highest_degree) : highest_degree_(std::max(highest_degree, 0)) {
    constexpr int most = 1000;
    if (highest_degree < 0 || highest_degree > most)
        throw InputError(fmt::format("roots of polynomials of degree {} cannot be found", highest_degree),
                         fmt::format("give a degree from 0 to {}", most));
    const std::size_t size = static_cast<std::size_t>(highest_degree_) + 1;
    reciprocals_.reserve(size * (size + 1) / 2);
    power_.resize(size);
    slope_.resize(size);
    coefficients_ = std::make_unique_for_overwrite<BernsteinCoefficient[]>((Isolation::stack_rows + 1) * size);
    stack_.reserve(Isolation::stack_rows);
}

/// Computed on demand: most polynomials do not need them, and a short trajectory should not pay for them.
void RootFinder::find_reciprocals() {
    if (!reciprocals_.empty())
        return;
    const std::size_t size = power_.size();
    for (std::size_t n = 0; n < size; ++n) {
        double binomial = 1;
        for (std::size_t k = 0; k <= n; ++k) {
            reciprocals_.push_back(1 / binomial);
            binomial = binomial * static_cast<double>(n - k) / static_cast<double>(k + 1);
        }
    }
}

RootFinder::Enclosure RootFinder::enclosure(std::span<const double> c, double length, RootStart start) {
    // With S_m = c_0 + ... + c_m h^m and x = s / h, summation by parts gives
    //   p(s) = sum_{m<n} S_m (x^m - x^{m+1}) + S_n x^n,
    // a convex combination: p is at least the least partial sum at h. (It is also what the nested bound
    // L_k = c_k + h min(L_{k+1}, 0) amounts to.) Each term is reduced by its share of the round-off: k u for the
    // power, n u for the sums, 4 u for the coefficient itself.
    const std::size_t first = start == RootStart::deflate ? 1 : 0;
    const double share = unit_roundoff * static_cast<double>(2 * c.size() + 8);
    double sum = 0, size = 0, power = 1, least = infinity;
    for (std::size_t k = first; k < c.size(); ++k) {
        const double term = c[k] * power, magnitude = std::abs(term);
        sum += term - share * magnitude;
        size += magnitude;
        least = std::min(least, sum);
        power *= length;
    }
    return {size < infinity && least < infinity ? least : -infinity, size};
}

bool RootFinder::surely_positive(std::span<const double> c, double length, RootStart start) {
    return enclosure(c, length, start).least > 0 && length > 0;
}

int RootFinder::trend(std::span<const double> c, double length) {
    return roots::kept_sign(c, 1, length, [](double k) { return k; }).sign;
}

/// Returns the minimum of a polynomial that is convex throughout. @param slope at the end
double RootFinder::lowest_place(std::span<const double> c, double length, double slope) {
    if (c[1] >= 0 || slope <= 0)
        return c[1] >= 0 ? 0 : length;
    for (std::size_t k = 1; k < c.size(); ++k)
        slope_[k - 1] = static_cast<double>(k) * c[k];
    return roots::refine(std::span(slope_).first(c.size() - 1), 0, length, -1, length * c[1] / (c[1] - slope));
}

/// Finds the falling root of a polynomial that is positive at first and decreasing or convex throughout.
/// @param way its trend, as from `trend`
/// @return whether there is one; nothing if the polynomial is not of this kind, or may have a touch
std::optional<bool> RootFinder::falls_once_or_never(std::span<const double> c, double length, int way, double touch,
                                                    Root& root) {
    const roots::Kept bend = way == 0 ? kept_bend(c, length) : roots::Kept{};
    if (way == 0 && bend.sign <= 0)
        return std::nullopt;
    const PointValue end = evaluate(c, length);
    double at = length;
    if (end.sign() >= 0) {
        if (way == 0)
            at = lowest_place(c, length, end.slope);
        const PointValue lowest = way == 0 ? evaluate(c, at) : end;
        if ((way == 0 ? least_around(lowest, bend.least, at, length - at) : end.value - end.value_error) > touch)
            return false;
        if (lowest.sign() >= 0)
            return std::nullopt;
    }
    const double guess = way < 0 ? roots::guess_of_monotone(c, length, end) : -c[0] / c[1];
    at = roots::refine(c, 0, at, 1, guess);
    root = {RootKind::falling, at, evaluate_polynomial(c, at)};
    return true;
}

bool RootFinder::first_falling(std::span<const double> c, double length, RootStart start, Root& root, double touch,
                               std::vector<Root>* touches) {
    if (!touches && surely_positive(c, length, start))
        return false;
    const int way = trend(c, length);
    if (way > 0 && (start == RootStart::deflate || (!c.empty() && c[0] > 0)))
        return false;
    if (start == RootStart::as_is && has_room(c) && !c.empty() && c[0] > 0)
        if (const auto found = falls_once_or_never(c, length, way, touch, root))
            return *found;
    Isolation isolation(*this, c, length, start);
    if (!isolation.usable())
        return false;
    Tracker tracker(isolation.power(), isolation.quotient(), isolation.sign_at_start());
    tracker.only_first_falling = true;
    tracker.touch = touch;
    tracker.touches = touches;
    if (isolation.scan(tracker))
        return false;
    root = tracker.first;
    if (start == RootStart::deflate)
        restore_start(c, length, root);
    return true;
}

void RootFinder::crossings(std::span<const double> c, double length, RootStart start, std::vector<Root>& roots) {
    roots.clear();
    if (start == RootStart::as_is && has_room(c) && crosses_once_or_never(c, length, roots))
        return;
    Isolation isolation(*this, c, length, start);
    if (!isolation.usable())
        return;
    Tracker tracker(isolation.power(), isolation.quotient(), isolation.sign_at_start());
    tracker.crossings = &roots;
    isolation.scan(tracker);
    if (start == RootStart::deflate)
        for (Root& root : roots)
            restore_start(c, length, root);
}

/// @return true if one pass proves that there is at most one crossing; it is stored in `roots`
bool RootFinder::crosses_once_or_never(std::span<const double> c, double length, std::vector<Root>& roots) {
    const std::optional<roots::SingleCrossing> single = roots::single_crossing(c, length);
    if (single && single->crosses) {
        const double at = single->place(c, length);
        roots.push_back({single->at_start > 0 ? RootKind::falling : RootKind::rising, at, evaluate_polynomial(c, at)});
    }
    return single.has_value();
}

/// Finds the minimum of a monotone, convex or concave polynomial. @return whether this polynomial is one
bool RootFinder::simple_minimum(std::span<const double> c, double length, Minimum& minimum) {
    if (c.empty() || !std::isfinite(c[0]))
        return false;
    const int way = trend(c, length);
    const roots::Kept bend = way == 0 ? kept_bend(c, length) : roots::Kept{};
    if (way == 0 && bend.sign == 0)
        return false;
    const double bound_at_start = c[0] - 4 * unit_roundoff * std::abs(c[0]);
    if (way > 0) {
        minimum = {0, c[0], bound_at_start};
        return true;
    }
    const PointValue end = evaluate(c, length);
    const double bound_at_end = end.value - end.value_error;
    if (bend.sign <= 0) { // the minimum is at an end
        minimum =
            way == 0 && c[0] <= end.value ? Minimum{0, c[0], bound_at_start} : Minimum{length, end.value, bound_at_end};
        if (way == 0)
            minimum.lower_bound = std::min(bound_at_start, bound_at_end);
        return true;
    }
    const double at = lowest_place(c, length, end.slope);
    const PointValue point = evaluate(c, at);
    minimum = {at, point.value, least_around(point, bend.least, at, length - at)};
    return true;
}

Minimum RootFinder::minimum(std::span<const double> c, double length) {
    if (Minimum minimum; has_room(c) && length < infinity && simple_minimum(c, length, minimum))
        return minimum;
    Isolation isolation(*this, c, length, RootStart::as_is);
    if (isolation.usable())
        return isolation.minimum();
    const bool zero = std::all_of(c.begin(), c.end(), [](double x) { return x == 0; });
    return zero ? Minimum{0, 0, 0} : Minimum{0, -infinity, -infinity};
}

double RootFinder::resolution(std::span<const double> c, double length) {
    return evaluate(c, length).value_error;
}

namespace {

// Sums in four parts, in powers of s^4, which processors evaluate side by side.
template <class Coefficient>
double sum_in_parts(std::size_t size, double s, Coefficient c) {
    const double square = s * s, step = square * square;
    double part[4] = {0, 0, 0, 0};
    std::size_t k = size;
    for (; k % 4 != 0; --k)
        part[(k - 1) % 4] = c(k - 1);
    for (; k > 0; k -= 4)
        for (std::size_t j = 0; j < 4; ++j)
            part[j] = part[j] * step + c(k - 4 + j);
    return (part[0] + part[1] * s) + (part[2] + part[3] * s) * square;
}

} // namespace

/// Evaluates the same sums, two side by side.
double evaluate_polynomial(std::span<const double> c, double s) {
    const double square = s * s, step = square * square;
    const std::size_t rest = c.size() % 4;
    const double* at = c.data() + (c.size() - rest);
    NumberPair low{}, high{};
    if (rest == 1)
        low = NumberPair{at[0], 0};
    else if (rest > 1)
        low = load_pair(at);
    if (rest == 3)
        high = NumberPair{at[2], 0};
    while (at != c.data()) {
        at -= 4;
        low = low * step + load_pair(at);
        high = high * step + load_pair(at + 2);
    }
    return (low[0] + low[1] * s) + (high[0] + high[1] * s) * square;
}

double evaluate_polynomial(const Series& c, std::size_t size, double s) {
    if (c.stride == 1)
        return evaluate_polynomial({c.first, size}, s);
    return sum_in_parts(size, s, [c](std::size_t k) { return c[k]; });
}

double evaluate_derivative(std::span<const double> c, double s) {
    return sum_in_parts(c.empty() ? 0 : c.size() - 1, s,
                        [c](std::size_t k) { return static_cast<double>(k + 1) * c[k + 1]; });
}

} // namespace graze
