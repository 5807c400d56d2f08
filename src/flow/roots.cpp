#include "graze/flow/roots.hpp"

#include "graze/symbolic/input_error.hpp"
#include "root_isolation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze {

using bernstein::unit_roundoff;
using roots::evaluate;
using roots::PointValue;
using roots::Tracker;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Moves a root of a polynomial whose c[0] was taken for 0 to where the true one puts it, if it is that well defined.
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

} // namespace

RootFinder::RootFinder(int highest_degree) : highest_degree_(std::max(highest_degree, 0)) {
    constexpr int most = 1000;
    if (highest_degree < 0 || highest_degree > most)
        throw InputError(fmt::format("roots of polynomials of degree {} cannot be found", highest_degree),
                         fmt::format("give a degree from 0 to {}", most));
    const std::size_t size = static_cast<std::size_t>(highest_degree_) + 1;
    reciprocals_.reserve(size * (size + 1) / 2);
    for (std::size_t n = 0; n < size; ++n) {
        double binomial = 1;
        for (std::size_t k = 0; k <= n; ++k) {
            reciprocals_.push_back(1 / binomial);
            binomial = binomial * static_cast<double>(n - k) / static_cast<double>(k + 1);
        }
    }
    power_.resize(size);
    slope_.resize(size);
    coefficients_.resize((Isolation::stack_rows + 1) * size);
    stack_.reserve(Isolation::stack_rows);
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
    // As in `enclosure`, of the derivative; the factor k has a round-off of its own.
    const double share = unit_roundoff * static_cast<double>(2 * c.size() + 9);
    double low = 0, high = 0, power = 1, least = infinity, greatest = -infinity;
    for (std::size_t k = 1; k < c.size(); ++k) {
        const double term = static_cast<double>(k) * c[k] * power, uncertainty = share * std::abs(term);
        low += term - uncertainty;
        high += term + uncertainty;
        least = std::min(least, low);
        greatest = std::max(greatest, high);
        power *= length;
    }
    if (!(high - low < infinity) || !(length > 0) || c.size() < 2)
        return 0;
    return least > 0 ? 1 : greatest < 0 ? -1 : 0;
}

bool RootFinder::first_falling(std::span<const double> c, double length, RootStart start, Root& root, double touch,
                               std::vector<Root>* touches) {
    if (!touches && surely_positive(c, length, start))
        return false;
    switch (trend(c, length)) {
    case 1:
        if (start == RootStart::deflate || evaluate(c, 0).sign() > 0)
            return false;
        break;
    case -1:
        if (start == RootStart::as_is && evaluate(c, 0).sign() > 0 && evaluate(c, length).sign() < 0) {
            const double end = evaluate_polynomial(c, length);
            const double at = roots::refine(c, 0, length, 1, length * c[0] / (c[0] - end));
            root = {RootKind::falling, at, evaluate_polynomial(c, at)};
            return true;
        }
        break;
    default:
        break;
    }
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

Minimum RootFinder::minimum(std::span<const double> c, double length) {
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

// In four parts, by powers of s^4, which processors work on side by side.
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

double evaluate_polynomial(std::span<const double> c, double s) {
    return sum_in_parts(c.size(), s, [c](std::size_t k) { return c[k]; });
}

double evaluate_polynomial(const Series& c, std::size_t size, double s) {
    return sum_in_parts(size, s, [c](std::size_t k) { return c[k]; });
}

double evaluate_derivative(std::span<const double> c, double s) {
    return sum_in_parts(c.empty() ? 0 : c.size() - 1, s,
                        [c](std::size_t k) { return static_cast<double>(k + 1) * c[k + 1]; });
}

} // namespace graze
