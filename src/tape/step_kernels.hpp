#pragma once

// The largest step for which series may be used, for all lanes at once. To be included only by the translation unit of
// an instruction set.

#include "tape/smallest_size.hpp"
#include "tape/sum_kernels.hpp"

#include "graze/tape/series.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {

typedef long long Integers __attribute__((vector_size(8 * lanes)));

GRAZE_INLINE double where_zero(double a, double yes, double no) {
    return a == 0 ? yes : no;
}
template <int n>
GRAZE_INLINE Packs<n> where_zero(Packs<n> a, Packs<n> yes, Packs<n> no) {
    return GRAZE_FOR_PARTS(Packs<n>, a.part[i] == 0 ? yes.part[i] : no.part[i]);
}

/// Splits a positive number into a power of 2 and a factor from 1 to 2.
template <class Real, class Integer>
GRAZE_INLINE void split_exponent(Real a, Real& exponent, Real& factor) {
    const Integer bits = __builtin_bit_cast(Integer, a);
    factor = __builtin_bit_cast(Real, (bits & 0x000fffffffffffff) | 0x3ff0000000000000);
    exponent = __builtin_bit_cast(Real, (bits >> 52) | 0x4330000000000000) - (0x1p52 + 1023);
}
/// Returns 2 to the power of the nearest integer, and the remainder of the exponent.
template <class Real, class Integer>
GRAZE_INLINE void raise_integer(Real exponent, Real& power, Real& rest) {
    const Real shifted = exponent + 0x1.8p52; // its last bits hold the integer
    rest = exponent - (shifted - 0x1.8p52);
    power = __builtin_bit_cast(Real, (__builtin_bit_cast(Integer, shifted) + 1023) << 52);
}
GRAZE_INLINE void split_exponent(double a, double& exponent, double& factor) {
    split_exponent<double, long long>(a, exponent, factor);
}
GRAZE_INLINE void raise_integer(double exponent, double& power, double& rest) {
    raise_integer<double, long long>(exponent, power, rest);
}
template <int n>
GRAZE_INLINE void split_exponent(Packs<n> a, Packs<n>& exponent, Packs<n>& factor) {
    for (int i = 0; i < n; ++i)
        split_exponent<Pack, Integers>(a.part[i], exponent.part[i], factor.part[i]);
}
template <int n>
GRAZE_INLINE void raise_integer(Packs<n> exponent, Packs<n>& power, Packs<n>& rest) {
    for (int i = 0; i < n; ++i)
        raise_integer<Pack, Integers>(exponent.part[i], power.part[i], rest.part[i]);
}

template <class L>
GRAZE_INLINE L number(double value) {
    return Numbers<L>::of(value);
}

/// Returns constant + slope x.
template <class L>
GRAZE_INLINE L line(double constant, double slope, L x) {
    return multiply_add(number<L>(slope), x, number<L>(constant));
}

// The next two functions are on the critical path of a step. Their terms are summed in pairs, which unlike Horner's
// rule do not wait for each other.

/// Returns log2 of positive normal numbers to 12 digits: with t = (a - r) / (a + r), ln(a / r) = 2 (t + t^3/3 + ...).
template <class L>
GRAZE_INLINE L logarithm(L a) {
    constexpr double root = 1.4142135623730951, per_unit = 2.8853900817779268; // sqrt 2, 2 / ln 2
    L exponent, factor;
    split_exponent(a, exponent, factor);
    const L t = (factor - number<L>(root)) / (factor + number<L>(root));
    const L x = t * t, square = x * x;
    const L low = multiply_add(line(1.0 / 5, 1.0 / 7, x), square, line(1, 1.0 / 3, x));
    const L high = multiply_add(number<L>(1.0 / 13), square, line(1.0 / 9, 1.0 / 11, x));
    const L sum = multiply_add(high, square * square, low);
    return exponent + multiply_add(sum * t, number<L>(per_unit), number<L>(0.5));
}

/// Returns 2^a to 12 digits, for |a| < 1000.
template <class L>
GRAZE_INLINE L power_of_two(L a) {
    constexpr double unit = 0.69314718055994531; // ln 2
    L power, rest;
    raise_integer(a, power, rest);
    const L x = rest * unit, square = x * x, fourth = square * square;
    const L low = multiply_add(line(1.0 / 2, 1.0 / 6, x), square, line(1, 1, x));
    const L middle = multiply_add(line(1.0 / 720, 1.0 / 5040, x), square, line(1.0 / 24, 1.0 / 120, x));
    const L high = multiply_add(number<L>(1.0 / 3628800), square, line(1.0 / 40320, 1.0 / 362880, x));
    return multiply_add(multiply_add(high, fourth, middle), fourth, low) * power;
}

template <class L>
GRAZE_INLINE L integer_power(L a, int exponent) {
    L power = number<L>(1);
    for (; exponent > 0; exponent /= 2) {
        if (exponent % 2 == 1)
            power = power * a;
        a = a * a;
    }
    return power;
}

/// Largest ratio of the last two terms to the two before. It is 0.02 at the optimal step of a series with finite
/// radius.
inline constexpr double largest_growth = 0.5;

/// Largest ratio of the last terms of a quotient to its size: that at 0.7 of the radius of convergence.
struct LargestShares {
    double of[highest_order + 1] = {};
    constexpr LargestShares() {
        of[0] = 1;
        for (int k = 1; k <= highest_order; ++k)
            of[k] = of[k - 1] * (k % 2 == 1 ? largest_growth : 1);
    }
};
inline constexpr LargestShares largest_share;

/// Shortens the step of one lane until the terms do not grow at the end of any series: the last two must be smaller
/// than the two before or, where a series has gaps there, such as that of x' = x^3 near zero, than earlier ones.
inline double shortened(const Series* series, std::size_t count, std::size_t order, int lane, double step) {
    constexpr std::size_t most_pairs = 4; // of earlier terms: gaps of up to seven terms
    for (std::size_t i = 0; i < count; ++i) {
        const auto size_at = [&](std::size_t k) {
            return __builtin_fabs(series[i].first[k * series[i].stride + static_cast<std::size_t>(lane)]);
        };
        // The terms of two orders, divided by a power of the step.
        const auto pair_at = [&](std::size_t k) { return greater(size_at(k) * step, size_at(k - 1)); };
        const double earlier = pair_at(order - 2);
        if (earlier == 0 || integer_power(step, static_cast<int>(order) - 3) * earlier < smallest_size)
            continue;
        for (int sweep = 0; sweep < 20; ++sweep) {
            double end = pair_at(order), allowed = 1, factor = 0; // that makes the last terms as small as needed
            for (std::size_t k = 1; k <= most_pairs && 2 * k < order && factor < 1; ++k) {
                end *= step * step;
                allowed *= largest_growth;
                const double start = allowed * pair_at(order - 2 * k);
                factor = greater(factor, end > start ? ::pow(0.9 * start / end, 0.5 / static_cast<double>(k)) : 1);
            }
            if (factor == 1)
                break;
            step *= factor;
        }
    }
    return step;
}

/// Returns the size, or `otherwise()` in lanes where it is zero.
template <class Otherwise>
GRAZE_INLINE double first_terms_or(double size, Otherwise&& otherwise) {
    return size == 0 ? otherwise() : size;
}
template <int n, class Otherwise>
GRAZE_INLINE Packs<n> first_terms_or(Packs<n> size, Otherwise&& otherwise) {
    return where_zero(size, otherwise(), size);
}

/// Returns the logarithms of two numbers in each lane.
template <class L>
GRAZE_INLINE void logarithms(L a, L b, L& of_a, L& of_b) {
    of_a = logarithm(a);
    of_b = logarithm(b);
}
/// With a single lane, both fit into one register.
GRAZE_INLINE void logarithms(double a, double b, double& of_a, double& of_b) {
    Packs<1> both = number<Packs<1>>(1);
    both.part[0][0] = a;
    both.part[0][1] = b;
    const Pack result = logarithm(both).part[0];
    of_a = result[0];
    of_b = result[1];
}

/// Returns the logarithm of the largest step at which the last two terms are at most the tolerance, from their largest
/// relative sizes.
template <class L>
GRAZE_INLINE L logarithm_of_step(L high, L low, double log_tolerance, int order) {
    L log_high, log_low;
    logarithms(high, low, log_high, log_low);
    const L at_last = (number<L>(log_tolerance) - log_high) * (1.0 / order);
    const L at_before = (number<L>(log_tolerance) - log_low) * (1.0 / (order - 1));
    return lesser(where_zero(high, number<L>(1000), at_last), where_zero(low, number<L>(1000), at_before));
}

/// Finds the largest step at which the last two terms of each series, relative to its size, are at most 2^log_tolerance
/// and smaller than those before them.
/// @param references lengths of time at which the sizes are taken
/// @param steps infinity where the last two terms are all zero, NaN where a coefficient is not finite
template <class V>
void steps(const FollowedSeries& followed, int order, double log_tolerance, const double* references, double* steps) {
    constexpr int width = Numbers<V>::width;
    constexpr double infinity = __builtin_inf();
    const auto n = static_cast<std::size_t>(order);
    double limits[2][width], sums[width], growths[width];
    const V reference = Numbers<V>::load(references);
    V high = number<V>(0), low = high, sum = high;
    const Series* const series = followed.series;
    const std::size_t count = followed.count, stride = count > 0 ? series[0].stride : 0;
    const auto at = [&](std::size_t i, std::size_t k) __attribute__((always_inline)) {
        return Numbers<V>::load(series[i].first + k * stride);
    };
    for (std::size_t i = 0; i < followed.line_count; ++i) {
        const Series& line = followed.lines[i];
        sum = sum + (Numbers<V>::load(line.first) + Numbers<V>::load(line.first + line.stride)) * 0.0;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const V c0 = at(i, 0), c1 = at(i, 1), c2 = at(i, 2);
        const V last = absolute(at(i, n)), before = absolute(at(i, n - 1));
        // The sum is not finite as soon as one coefficient is not. (For a logarithm of a negative number only the first
        // coefficient is not finite.)
        sum = sum + (last + before) + (c0 + c1 + c2) * 0.0;
        const V first_terms = absolute(c0) + reference * (absolute(c1) + reference * absolute(c2));
        const V size = first_terms_or(
            first_terms, [&]() __attribute__((always_inline)) {
                return (before + reference * last) * integer_power(reference, order - 1);
            });
        const V measure = greater(size, number<V>(smallest_size));
        high = greater(high, last / measure);
        low = greater(low, before / measure);
    }
    const V limit = logarithm_of_step(high, low, log_tolerance, order);
    const V step = power_of_two(greater(lesser(limit, number<V>(1000)), number<V>(-1000)));
    // Where terms grow at the end of the series, the truncated terms are larger still, however small: for example
    // exp(-100 x^2) far from its peak, over which a step must not lead. Pairs of terms are compared, since every other
    // term of an even or odd function is zero.
    V growth = number<V>(0);
    for (std::size_t i = 0; i < count; ++i) {
        const V end = greater(absolute(at(i, n)) * step, absolute(at(i, n - 1))) * (step * step);
        const V start = greater(absolute(at(i, n - 2)) * step, absolute(at(i, n - 3)));
        growth = greater(growth, where_zero(start, start, end - start * largest_growth));
    }
    Numbers<V>::store(limits[0], high);
    Numbers<V>::store(limits[1], low);
    Numbers<V>::store(sums, sum);
    Numbers<V>::store(growths, growth);
    Numbers<V>::store(steps, step);
    for (int lane = 0; lane < width; ++lane) {
        if (!(sums[lane] < infinity))
            steps[lane] = __builtin_nan("");
        else if (limits[0][lane] == 0 && limits[1][lane] == 0)
            steps[lane] = infinity;
        else if (growths[lane] > 0)
            steps[lane] = shortened(series, count, n, lane, steps[lane]);
    }
}

} // namespace graze::GRAZE_INSTRUCTION_SET
