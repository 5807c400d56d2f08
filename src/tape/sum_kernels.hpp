#pragma once

// What is asked of series once they are known, for all lanes at once. To be included only by the translation unit of an
// instruction set.

#include "tape/lane_numbers.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {

/// Lanes side by side whatever they mean: in a sum, derivatives are numbers like others.
template <class V>
struct PlainNumbers {
    using Type = Packs<V::parts>;
};
template <>
struct PlainNumbers<double> {
    using Type = double;
};
template <class V>
using Plain = typename PlainNumbers<V>::Type;

GRAZE_INLINE double absolute(double a) {
    return a < 0 ? -a : a;
}
GRAZE_INLINE double lesser(double a, double b) {
    return b < a ? b : a;
}
template <int n>
GRAZE_INLINE Packs<n> absolute(Packs<n> a) {
    return GRAZE_FOR_PARTS(Packs<n>, a.part[i] < 0 ? -a.part[i] : a.part[i]);
}
template <int n>
GRAZE_INLINE Packs<n> lesser(Packs<n> a, Packs<n> b) {
    return GRAZE_FOR_PARTS(Packs<n>, b.part[i] < a.part[i] ? b.part[i] : a.part[i]);
}

/// Sum of the series at a time of its own in each lane, by Horner's rule.
template <class V>
void sum(const double* series, int order, const double* times, double* values) {
    using L = Plain<V>;
    const L time = Numbers<L>::load(times);
    L value = at<L>(series, order);
    for (int k = order; k-- > 0;)
        value = multiply_add(value, time, at<L>(series, k));
    Numbers<L>::store(values, value);
}

/// The same, and the derivative there.
template <class V>
void sum_and_slope(const double* series, int order, const double* times, double* values, double* slopes) {
    using L = Plain<V>;
    const L time = Numbers<L>::load(times);
    L value = at<L>(series, order);
    L slope = value;
    for (int k = order; k-- > 1;) {
        value = multiply_add(value, time, at<L>(series, k));
        slope = multiply_add(slope, time, value);
    }
    Numbers<L>::store(slopes, slope);
    Numbers<L>::store(values, multiply_add(value, time, at<L>(series, 0)));
}

/// By how much slopes and rates differ more than is allowed, the worst of all states: h |slope - rate| less `allowed`
/// times the size, which is that of StepCheck. What is not finite is infinite.
template <class V>
void disagreement(const Series* series, const Series* ends, std::size_t count, const double* lengths,
                  const double* values, const double* slopes, double allowed, double smallest, double* worst) {
    using L = Plain<V>;
    constexpr int width = Numbers<V>::width;
    const auto magnitude = [](L a) __attribute__((always_inline)) {
        return absolute(a);
    };
    const auto larger = [](L a, L b) __attribute__((always_inline)) {
        return -lesser(-a, -b);
    };
    const L length = Numbers<L>::load(lengths);
    L most = Numbers<L>::of(0), sum = most;
    for (std::size_t i = 0; i < count; ++i) {
        const L start = Numbers<L>::load(series[i].first), start_rate = at<L>(series[i].first, 1);
        const L end = Numbers<L>::load(values + i * width), end_rate = at<L>(ends[i].first, 1);
        const L rates = larger(magnitude(start_rate), magnitude(end_rate)) * length;
        const L size = larger(magnitude(start), magnitude(end)) + Numbers<L>::of(smallest) + rates * 0.25;
        const L difference = magnitude(Numbers<L>::load(slopes + i * width) - end_rate) * length;
        const L excess = difference - size * allowed;
        most = larger(most, excess);
        sum = sum + excess * 0.0;
    }
    double sums[width];
    Numbers<L>::store(worst, most);
    Numbers<L>::store(sums, sum);
    for (int lane = 0; lane < width; ++lane)
        if (sums[lane] != 0)
            worst[lane] = __builtin_inf();
}

/// With S_m = c_0 + ... + c_m h^m and x = s / h, summation by parts gives
///   p(s) = sum_{m<n} S_m (x^m - x^{m+1}) + S_n x^n,
/// a convex combination: p is at least the least partial sum at h. Each term is reduced by its share of the round-off:
/// k u for the power, n u for the sums, 4 u for the coefficient itself.
template <class V>
void bound(const double* series, int order, const double* lengths, double* least, double* sizes, double* ends) {
    using L = Plain<V>;
    constexpr int width = Numbers<V>::width;
    const double share = -0x1p-53 * (2 * order + 10);
    const L length = Numbers<L>::load(lengths);
    L size = absolute(at<L>(series, 0)), bound = at<L>(series, 0) + size * share, partial = bound, power = length;
    for (int k = 1; k <= order; ++k) {
        const L term = at<L>(series, k) * power;
        const L magnitude = absolute(term);
        partial = partial + (term + magnitude * share);
        size = size + magnitude;
        bound = lesser(bound, partial);
        power = power * length;
    }
    Numbers<L>::store(sizes, size);
    Numbers<L>::store(least, bound);
    Numbers<L>::store(ends, partial - size * share);
    for (int lane = 0; lane < width; ++lane)
        if (!(sizes[lane] <= 0x1.fffffffffffffp1023))
            least[lane] = -__builtin_inf();
}

} // namespace graze::GRAZE_INSTRUCTION_SET
