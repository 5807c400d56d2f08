#pragma once

// Evaluation and bounds of known series, for all lanes at once. To be included only by the translation unit of an
// instruction set.

#include "tape/kernel_table.hpp"
#include "tape/lane_numbers.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {

GRAZE_INLINE double absolute(double a) {
    return __builtin_fabs(a);
}
GRAZE_INLINE double lesser(double a, double b) {
    return b < a ? b : a;
}
GRAZE_INLINE double greater(double a, double b) {
    return b > a ? b : a;
}
template <int n>
GRAZE_INLINE Packs<n> greater(Packs<n> a, Packs<n> b) {
    return GRAZE_FOR_PARTS(Packs<n>, b.part[i] > a.part[i] ? b.part[i] : a.part[i]);
}
template <int n>
GRAZE_INLINE Packs<n> absolute(Packs<n> a) {
    return GRAZE_FOR_PARTS(Packs<n>, absolute(a.part[i]));
}
template <int n>
GRAZE_INLINE Packs<n> lesser(Packs<n> a, Packs<n> b) {
    return GRAZE_FOR_PARTS(Packs<n>, b.part[i] < a.part[i] ? b.part[i] : a.part[i]);
}

/// Evaluates a series by Horner's rule, in each lane at its own time.
template <class V>
void sum(const double* series, int order, const double* times, double* values) {
    const V time = Numbers<V>::load(times);
    V value = at<V>(series, order);
    for (int k = order; k-- > 0;)
        value = multiply_add(value, time, at<V>(series, k));
    Numbers<V>::store(values, value);
}

/// Evaluates several series and their derivatives.
/// @param degrees degree of each series, at least 1; @param values, slopes [series * width + lane]
template <class V>
void sums_and_slopes(const Series* series, const int* degrees, std::size_t count, const double* times, double* values,
                     double* slopes) {
    constexpr std::size_t width = Numbers<V>::width;
    const V time = Numbers<V>::load(times);
    for (std::size_t i = 0; i < count; ++i) {
        const double* const first = series[i].first;
        const double* coefficient = first + degrees[i] * static_cast<std::ptrdiff_t>(width);
        V value = Numbers<V>::load(coefficient);
        V slope = value;
#pragma GCC unroll 4
        for (coefficient -= width; coefficient != first; coefficient -= width) {
            value = multiply_add(value, time, Numbers<V>::load(coefficient));
            slope = multiply_add(slope, time, value);
        }
        Numbers<V>::store(slopes + i * width, slope);
        Numbers<V>::store(values + i * width, multiply_add(value, time, at<V>(first, 0)));
    }
}

/// Returns the largest excess of the differences between polynomials and model at ends of steps over their allowance: h
/// |slope - rate| for states, differences of values for outputs. Infinity where a number is not finite.
template <class V>
void disagreement(const EndComparison& comparison, const EndValues& ends, const double* lengths, double* worst) {
    constexpr int width = Numbers<V>::width;
    constexpr double round_off = 0x1p-49;
    const V length = Numbers<V>::load(lengths);
    V most = Numbers<V>::of(0), sum = most;
    for (std::size_t i = 0; i < comparison.state_count; ++i) {
        const double* series = comparison.states[i].first;
        const std::size_t from = comparison.state_indices[i] * width;
        const V end_rate = at<V>(ends.there + (series - ends.here), 1);
        const V rates = greater(absolute(at<V>(series, 1)), absolute(end_rate)) * length;
        const V size = greater(absolute(at<V>(series, 0)), absolute(Numbers<V>::load(ends.values + from))) +
                       Numbers<V>::of(ends.allowance.smallest) + rates * 0.25;
        const V difference = absolute(Numbers<V>::load(ends.slopes + from) - end_rate) * length;
        const V excess = difference - size * ends.allowance.rates;
        most = greater(most, excess);
        sum = sum + excess;
    }
    for (std::size_t j = 0; j < comparison.output_count; ++j) {
        const double* series = comparison.outputs[j].first;
        V value = at<V>(series, comparison.order);
        V terms = absolute(value);
        for (int k = comparison.order; k-- > 0;) {
            value = multiply_add(value, length, at<V>(series, k));
            terms = multiply_add(terms, length, absolute(at<V>(series, k)));
        }
        const V size =
            absolute(at<V>(series, 0)) + length * (absolute(at<V>(series, 1)) + length * absolute(at<V>(series, 2)));
        const V difference = absolute(value - at<V>(ends.there + (series - ends.here), 0));
        const V excess =
            difference - ((size + Numbers<V>::of(ends.allowance.smallest)) * ends.allowance.values + terms * round_off);
        most = greater(most, excess);
        sum = sum + excess;
    }
    double sums[width];
    Numbers<V>::store(worst, most);
    Numbers<V>::store(sums, sum * 0.0);
    for (int lane = 0; lane < width; ++lane)
        if (sums[lane] != 0)
            worst[lane] = __builtin_inf();
}

/// With S_m = c_0 + ... + c_m h^m and x = s / h, summation by parts gives
///   p(s) = sum_{m<n} S_m (x^m - x^{m+1}) + S_n x^n,
/// a convex combination: p is at least the least partial sum at h. The relative round-off of term k is k u for the
/// power, n u for the sums, and 4 u for the coefficient itself; the total is bounded by that share of the sum of all
/// sizes.
template <class V>
void bound(const double* series, int order, const double* lengths, double* least, double* sizes) {
    constexpr int width = Numbers<V>::width;
    const double share = -0x1p-53 * (2 * order + 10);
    const V length = Numbers<V>::load(lengths);
    V partial = at<V>(series, 0), bound = partial, size = absolute(partial), power = length;
    const double* const end = series + (order + std::ptrdiff_t{1}) * width;
#pragma GCC unroll 4
    for (const double* coefficient = series + width; coefficient != end; coefficient += width) {
        const V term = Numbers<V>::load(coefficient) * power;
        partial = partial + term;
        size = size + absolute(term);
        bound = lesser(bound, partial);
        power = power * length;
    }
    bound = bound + size * share;
    Numbers<V>::store(sizes, size);
    Numbers<V>::store(least, bound);
    for (int lane = 0; lane < width; ++lane)
        if (!(sizes[lane] <= 0x1.fffffffffffffp1023))
            least[lane] = -__builtin_inf();
}

} // namespace graze::GRAZE_INSTRUCTION_SET
