#pragma once

// Sine and cosine of one number or of all lanes of a register by the same operations, so that lanes agree bit for bit.
// To be included only by the translation unit of an instruction set. Without fused multiply-add the library's functions
// are used instead.
//
// The argument is reduced by multiples of pi/2 given in three parts. Subtracting the first part is exact (the result is
// a multiple of 2^-53 and less than one); the part of the result beyond its first double is kept. The series are summed
// up to r^17 and r^18: the remainder is below 1e-19 of the sum for |r| <= pi/4. All corrections to the largest term are
// small and known beyond their rounding, so that errors are below 0.7 units in the last place (rounding alone takes
// 0.5).

#include "tape/lane_numbers.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {
#if defined(__FMA__)

/// Beyond this size, the multiples of pi/2 are no longer small integers.
inline constexpr double largest_reduced = 0x1p20;

template <class V>
struct BitsOf {
    typedef long long Type __attribute__((vector_size(8 * lanes)));
    GRAZE_INLINE static Pack of(double value) { return splat(value); }
};
template <>
struct BitsOf<double> {
    using Type = long long;
    GRAZE_INLINE static double of(double value) { return value; }
};

/// Returns the sum of c_i z^i.
template <class V, int count>
GRAZE_INLINE V terms_of(const double (&c)[count], V z) {
    V sum = BitsOf<V>::of(c[count - 1]);
    for (int i = count - 1; i-- > 0;)
        sum = multiply_add(sum, z, BitsOf<V>::of(c[i]));
    return sum;
}

/// @param a at most `largest_reduced` in size
/// @tparam V double or Pack
template <class V>
GRAZE_INLINE void reduced_sine_and_cosine(V a, V& sine, V& cosine) {
    using Bits = typename BitsOf<V>::Type;
    constexpr double of_sine[] = {-1. / 6,        1. / 120,        -1. / 5040,          1. / 362880,
                                  -1. / 39916800, 1. / 6227020800, -1. / 1307674368000, 1. / 355687428096000};
    constexpr double of_cosine[] = {1. / 24,        -1. / 720,         1. / 40320,          -1. / 3628800,
                                    1. / 479001600, -1. / 87178291200, 1. / 20922789888000, -1. / 6402373705728000};
    const auto number = [](double value) __attribute__((always_inline)) {
        return BitsOf<V>::of(value);
    };
    constexpr double to_integer = 0x1.8p52; // the last bits of the sum are those of the nearest integer
    const V shifted = multiply_add(a, number(0x1.45f306dc9c883p-1), number(to_integer));
    const V less = to_integer - shifted; // minus that integer
    const V first = multiply_add(less, number(0x1.921fb54442d18p+0), a);
    // Adding zero rounds the product, and keeps compilers from fusing it into the following sums.
    const V product = multiply_add(less, number(0x1.1a62633145c07p-54), number(0));
    const V product_rest = multiply_add(less, number(0x1.1a62633145c07p-54), -product);
    const V r = first + product, moved = r - first; // close to a multiple of pi/2 both may be of equal size
    const V rest =
        ((first - (r - moved)) + (product - moved)) + multiply_add(less, number(-0x1.f1976b7ed8fbcp-110), product_rest);
    const V z = r * r, half = z * 0.5, z_rest = multiply_add(r, r, -z);
    const V cube = z * r, cube_rest = multiply_add(z_rest, r, multiply_add(z, r, -cube));
    const V s =
        r + multiply_add(cube, terms_of(of_sine, z), multiply_add(cube_rest, number(of_sine[0]), rest * (1 - half)));
    const V most = 1 - half;
    const V small = multiply_add(z * z, terms_of(of_cosine, z), -multiply_add(r, rest, z_rest * 0.5));
    const V c = most + (((1 - most) - half) + small);
    const Bits quarter = __builtin_bit_cast(Bits, shifted);
    const auto odd = (quarter & 1) != 0;
    const V one = odd ? c : s, other = odd ? s : c;
    sine = __builtin_bit_cast(V, __builtin_bit_cast(Bits, one) ^ ((quarter & 2) << 62));
    cosine = __builtin_bit_cast(V, __builtin_bit_cast(Bits, other) ^ (((quarter + 1) & 2) << 62));
}

GRAZE_INLINE void evaluate_sine_and_cosine(double a, double& sine, double& cosine) {
    if (__builtin_fabs(a) <= largest_reduced) {
        reduced_sine_and_cosine(a, sine, cosine);
    } else {
        sine = ::sin(a);
        cosine = ::cos(a);
    }
}
GRAZE_INLINE void evaluate_sine_and_cosine(Pack a, Pack& sine, Pack& cosine) {
    reduced_sine_and_cosine(a, sine, cosine);
    if (lanes_above(absolute(a), splat(largest_reduced)) == 0)
        return;
    for (int lane = 0; lane < lanes; ++lane)
        if (!(__builtin_fabs(a[lane]) <= largest_reduced)) {
            sine[lane] = ::sin(a[lane]);
            cosine[lane] = ::cos(a[lane]);
        }
}

#else

inline void evaluate_sine_and_cosine(double a, double& sine, double& cosine) {
    sine = ::sin(a);
    cosine = ::cos(a);
}
inline void evaluate_sine_and_cosine(Pack a, Pack& sine, Pack& cosine) {
    for (int lane = 0; lane < lanes; ++lane) {
        const double argument = a[lane];
        sine[lane] = ::sin(argument);
        cosine[lane] = ::cos(argument);
    }
}

#endif

inline void evaluate_sine_and_cosine(Ensemble a, Ensemble& sine, Ensemble& cosine) {
    for (int i = 0; i < Ensemble::parts; ++i)
        evaluate_sine_and_cosine(a.part[i], sine.part[i], cosine.part[i]);
}

} // namespace graze::GRAZE_INSTRUCTION_SET
