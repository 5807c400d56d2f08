#pragma once

// The kernels: recurrences for the coefficients of power series (Griewank and Walther 2008, table 13.2), one source
// for all kinds of lanes and all instruction sets. To be included only by the translation unit of an instruction
// set. Loops over coefficients are unrolled up to `highest_unrolled`, as templates on the order.
//
// A jet of one lane is limited by latency: each coefficient waits for coefficients of the same order. Kernels therefore
// first sum everything that is known from lower orders; a coefficient of the same order then needs one or two more
// operations.

#include "tape/kernel_table.hpp"
#include "tape/lane_numbers.hpp"
#include "tape/sine_and_cosine.hpp"

#include <type_traits>
#include <utility>

namespace graze::GRAZE_INSTRUCTION_SET {

template <int... j>
using Indices = std::integer_sequence<int, j...>;

/// 1/k: a multiplication is faster than a division.
struct Inverses {
    double of[highest_order + 1] = {};
    constexpr Inverses() {
        for (int k = 1; k <= highest_order; ++k)
            of[k] = 1.0 / k;
    }
};
inline constexpr Inverses inverse;

/// Adds term j of a sum; four partial sums hide the latency of additions.
template <int j, class V>
GRAZE_INLINE void accumulate(V (&sums)[4], V a, V b) {
    if constexpr (j < 4)
        sums[j] = a * b;
    else
        sums[j % 4] = multiply_add(a, b, sums[j % 4]);
}
template <int terms, class V>
GRAZE_INLINE V total(const V (&sums)[4]) {
    if constexpr (terms == 1)
        return sums[0];
    else if constexpr (terms == 2)
        return sums[0] + sums[1];
    else if constexpr (terms == 3)
        return (sums[0] + sums[1]) + sums[2];
    else
        return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

#if defined(__FMA__)
/// The same sum for one lane, with the partial sums in the lanes of a register: fewer loads, the same bits.
template <int k, int first, int terms>
GRAZE_INLINE double sum_by_four(const double* a, const double* b) {
    const auto term = [&](int j) __attribute__((always_inline)) {
        return _mm256_permute4x64_pd(_mm256_loadu_pd(b + k - first - 3 - j), 0x1b);
    };
    __m256d sums = _mm256_mul_pd(_mm256_loadu_pd(a + first), term(0));
    [&]<int... j>(Indices<j...>) __attribute__((always_inline)) {
        ((sums = _mm256_fmadd_pd(_mm256_loadu_pd(a + first + 4 + std::ptrdiff_t{4} * j), term(4 + 4 * j), sums)), ...);
    }
    (std::make_integer_sequence<int, terms / 4 - 1>{});
    __m128d low = _mm256_castpd256_pd128(sums);
    __m128d high = _mm256_extractf128_pd(sums, 1);
    constexpr int done = terms / 4 * 4;
    if constexpr (terms - done >= 2) {
        const __m128d pair = _mm_loadu_pd(b + k - first - 1 - done);
        low = _mm_fmadd_pd(_mm_loadu_pd(a + first + done), _mm_shuffle_pd(pair, pair, 1), low);
    }
    if constexpr ((terms - done) % 2 == 1) {
        __m128d& sum = terms - done == 1 ? low : high;
        sum[0] = multiply_add(a[first + terms - 1], b[k - first - terms + 1], sum[0]);
    }
    const __m128d halves = _mm_hadd_pd(low, high);
    return halves[0] + halves[1];
}
#endif

/// Above this order sums are loops: unrolled, they would be most of what there is to compile. Tolerances choose orders
/// up to 20. The number is odd, so that pairs of orders are complete. The x86-64 processors without fused operations
/// are those of before 2013: they have loops nearly throughout.
#if defined(__x86_64__) && !defined(__FMA__)
inline constexpr int highest_unrolled = 3;
#else
inline constexpr int highest_unrolled = 21;
#endif

template <class V>
struct Factors {
    V left, right;
};
/// Returns the sum of products, as `accumulate` and `total` have it.
/// @param terms at least 4 @param factors those of term j
template <class V, class FactorsOf>
GRAZE_INLINE V sum_in_loop(Order terms, const FactorsOf& factors) {
    V sums[4];
    for (Order i = 0; i < 4; ++i) {
        const Factors<V> term = factors(i);
        sums[i] = term.left * term.right;
    }
    const auto add = [&](Order i, Order j) __attribute__((always_inline)) {
        const Factors<V> term = factors(j);
        sums[i] = multiply_add(term.left, term.right, sums[i]);
    };
    Order j = 4;
    for (; j + 4 <= terms; j += 4)
        for (Order i = 0; i < 4; ++i)
            add(i, j + i);
    for (Order i = 0; j < terms; ++i, ++j)
        add(i, j);
    return total<4>(sums);
}
template <int k, int terms>
inline constexpr bool in_loop = (k > highest_unrolled) && (terms >= 4);

template <class V>
[[gnu::noinline]] V long_sum_of_products(const double* a, const double* b, Order k, Order first, Order terms) {
    return sum_in_loop<V>(
        terms, [&](Order j) __attribute__((always_inline)) {
            return Factors<V>{at<V>(a, first + j), at<V>(b, k - first - j)};
        });
}

/// Sum of a[j] b[k-j], first <= j < first + terms.
template <class V, int k, int first, int terms>
GRAZE_INLINE V sum_of_products(const double* a, const double* b) {
    if constexpr (in_loop<k, terms>) {
        return long_sum_of_products<V>(a, b, k, first, terms);
    } else {
#if defined(__FMA__)
        if constexpr (Numbers<V>::width == 1 && terms >= 4)
            return sum_by_four<k, first, terms>(a, b);
#endif
        V sums[4];
        [&]<int... j>(Indices<j...>) __attribute__((always_inline)) {
            (accumulate<j>(sums, at<V>(a, first + j), at<V>(b, k - first - j)), ...);
        }
        (std::make_integer_sequence<int, terms>{});
        return total<terms>(sums);
    }
}

// The products of the coefficients that became known last, those of order k - 1, are added last: all others have been
// summed by then, and wide loads of them do not wait for numbers that have just been stored.

/// Sum of a[j] b[k-j], 0 < j < k; k >= 2.
template <class V, int k>
GRAZE_INLINE V convolution(const double* a, const double* b) {
    const V a1 = at<V>(a, 1);
    if constexpr (k == 2) {
        return a1 * at<V>(b, 1);
    } else {
        const V last = at<V>(b, k - 1);
        V sum;
        if constexpr (k == 3)
            sum = a1 * last;
        else
            sum = multiply_add(a1, last, sum_of_products<V, k, 2, k - 3>(a, b));
        return multiply_add(at<V>(a, k - 1), at<V>(b, 1), sum);
    }
}
/// Sum of a[j] a[k-j], 0 < j < k/2; k >= 3.
template <class V, int k>
GRAZE_INLINE V half_convolution(const double* a) {
    constexpr int terms = (k - 1) / 2;
    if constexpr (terms == 1)
        return at<V>(a, 1) * at<V>(a, k - 1);
    else
        return multiply_add(at<V>(a, 1), at<V>(a, k - 1), sum_of_products<V, k, 2, terms - 1>(a, a));
}

/// The convolutions of two orders at once. Ensembles are limited by loads, and this way each loaded coefficient serves
/// two products. (The sums have the same order of terms as those of `convolution` and `half_convolution`.)
template <class V, int k, bool half = false>
class TwoConvolutions {
    static constexpr int terms = half ? k / 2 - 2 : k - 3; ///< of the first, without those of order k - 1

public:
    GRAZE_INLINE TwoConvolutions(const double* a, const double* b)
        : a1_(at<V>(a, 1)), b1_(at<V>(b, 1)), last_(at<V>(b, k - 1)), next_(at<V>(b, k)), b_(last_) {
        [&]<int... j>(Indices<j...>) __attribute__((always_inline)) {
            (add<j>(at<V>(a, j + 2), at<V>(b, k - 2 - j)), ...);
        }
        (std::make_integer_sequence<int, terms>{});
        before_ = at<V>(a, terms + 2);
        accumulate<terms>(second_, before_, b_);
    }
    /// Sum of order k.
    GRAZE_INLINE V first() const {
        if constexpr (terms == 0) {
            return a1_ * last_;
        } else {
            const V sum = multiply_add(a1_, last_, total<terms>(first_));
            return half ? sum : multiply_add(before_, b1_, sum);
        }
    }
    /// Sum of order k + 1, given coefficient k of the first series.
    GRAZE_INLINE V second(V a) const {
        const V sum = multiply_add(a1_, next_, total<terms + 1>(second_));
        return half ? sum : multiply_add(a, b1_, sum);
    }

private:
    template <int j>
    GRAZE_INLINE void add(V a, V b) {
        accumulate<j>(first_, a, b);
        accumulate<j>(second_, a, b_);
        b_ = b;
    }

    V a1_, b1_, last_, next_; ///< coefficients 1 of both, then k - 1 and k of the second series
    V before_;                ///< the last a of the loop; k - 1 unless `half`
    V b_;                     ///< the last b loaded
    V first_[4], second_[4];
};

template <class V>
inline constexpr bool has_pairs = std::is_same_v<V, Ensemble>;
/// From this order on, the convolutions of an even order and the next odd order are computed together. The part of the
/// odd one is stored in the place of its coefficient until then.
inline constexpr int first_pair = 4;
template <class V, int k>
inline constexpr bool in_pair = has_pairs<V> && (k >= first_pair) && (k <= highest_unrolled);
template <class V, int k>
inline constexpr bool starts_pair = in_pair<V, k> && (k % 2 == 0);
template <class V, int k>
inline constexpr bool ends_pair = in_pair<V, k> && (k % 2 == 1);

/// Sum of a[j] a[k-j], 0 < j < k, given that over j < k/2; k >= 2.
template <class V, int k>
GRAZE_INLINE V self_convolution(const double* a, V half) {
    if constexpr (k % 2 == 1) {
        return half + half;
    } else {
        const V middle = at<V>(a, k / 2);
        return multiply_add(middle, middle, half + half);
    }
}
template <class V, int k>
GRAZE_INLINE V self_convolution(const double* a) {
    if constexpr (k == 2) {
        const V middle = at<V>(a, 1);
        return middle * middle;
    } else {
        return self_convolution<V, k>(a, half_convolution<V, k>(a));
    }
}

// Operations with paired orders have a second kernel at even orders, `closing`, for the last order of a series.

template <class V>
struct Multiply {
    template <int k, bool closing = false>
    GRAZE_INLINE static V run(const KernelOperands& o, Order) {
        const V a0 = at<V>(o.left, 0);
        const V b = at<V>(o.right, k);
        if constexpr (k == 0) {
            return put(o.result, 0, a0 * b);
        } else {
            const V a = at<V>(o.left, k);
            const V b0 = at<V>(o.right, 0);
            if constexpr (k == 1)
                return put(o.result, k, multiply_add(a0, b, a * b0));
            else
                return put(o.result, k, multiply_add(a0, b, multiply_add(a, b0, inner<k, closing>(o, a))));
        }
    }
    template <int k, bool closing>
    GRAZE_INLINE static V inner(const KernelOperands& o, V a) {
        if constexpr (ends_pair<V, k>) {
            return at<V>(o.result, k);
        } else if constexpr (starts_pair<V, k> && !closing) {
            TwoConvolutions<V, k> sums(o.left, o.right);
            put(o.result, k + 1, sums.second(a));
            return sums.first();
        } else {
            return convolution<V, k>(o.left, o.right);
        }
    }
};

template <class V>
struct Square {
    template <int k, bool closing = false>
    GRAZE_INLINE static V run(const KernelOperands& o, Order) {
        const V a = at<V>(o.left, k);
        if constexpr (k == 0) {
            return put(o.result, 0, a * a);
        } else {
            const V a0 = at<V>(o.left, 0);
            const V twice = a0 + a0;
            if constexpr (k == 1)
                return put(o.result, k, twice * a);
            else
                return put(o.result, k, multiply_add(twice, a, inner<k, closing>(o)));
        }
    }
    template <int k, bool closing>
    GRAZE_INLINE static V inner(const KernelOperands& o) {
        if constexpr (ends_pair<V, k>) {
            return self_convolution<V, k>(o.left, at<V>(o.result, k));
        } else if constexpr (starts_pair<V, k> && !closing) {
            TwoConvolutions<V, k, true> sums(o.left, o.left);
            put(o.result, k + 1, sums.second(at<V>(o.left, k)));
            return self_convolution<V, k>(o.left, sums.first());
        } else {
            return self_convolution<V, k>(o.left);
        }
    }
};

/// Coefficients of a quotient depend on one another: computes the convolution of quotient and divisor, and the known
/// part of that of the next order after `finish` has computed the coefficient of this one.
template <class V, int k, bool closing, class Finish>
GRAZE_INLINE V divide_by(const double* divisor, double* quotient, Finish finish) {
    if constexpr (ends_pair<V, k>) {
        return put(quotient, k, finish(at<V>(quotient, k)));
    } else if constexpr (starts_pair<V, k> && !closing) {
        TwoConvolutions<V, k> sums(quotient, divisor);
        const V result = finish(sums.first());
        put(quotient, k, result);
        put(quotient, k + 1, sums.second(result));
        return result;
    } else {
        return put(quotient, k, finish(convolution<V, k>(quotient, divisor)));
    }
}

/// q b = a; the reciprocal of b at order 0 is stored in `third`.
template <class V>
struct Divide {
    template <int k, bool closing = false>
    GRAZE_INLINE static V run(const KernelOperands& o, Order) {
        return run_of<k, closing>(o, at<V>(o.left, k));
    }
    /// @param a coefficient k of the dividend
    template <int k, bool closing = false>
    GRAZE_INLINE static V run_of(const KernelOperands& o, V a) {
        if constexpr (k == 0) {
            const V b0 = at<V>(o.right, 0);
            put(o.third, 0, Numbers<V>::of(1) / b0);
            return put(o.result, 0, a / b0);
        } else {
            const V reciprocal = at<V>(o.third, 0);
            const V slope = -(at<V>(o.result, 0) * reciprocal);
            if constexpr (k == 1)
                return put(o.result, k, multiply_add(a, reciprocal, slope * at<V>(o.right, k)));
            else
                return divide_by<V, k, closing>(
                    o.right, o.result, [&](V sum) __attribute__((always_inline)) {
                        return multiply_add(a, reciprocal, multiply_add(slope, at<V>(o.right, k), -(sum * reciprocal)));
                    });
        }
    }
};

template <class V>
struct Reciprocal {
    template <int k, bool closing = false>
    GRAZE_INLINE static V run(const KernelOperands& o, Order) {
        const V a = at<V>(o.left, k);
        if constexpr (k == 0) {
            return put(o.result, 0, Numbers<V>::of(1) / a);
        } else {
            const V reciprocal = at<V>(o.result, 0);
            const V slope = -(reciprocal * reciprocal);
            if constexpr (k == 1)
                return put(o.result, k, slope * a);
            else
                return divide_by<V, k, closing>(
                    o.left, o.result, [&](V sum) __attribute__((always_inline)) {
                        return multiply_add(slope, a, -(sum * reciprocal));
                    });
        }
    }
};

/// y y = a; 1/(2 y) at order 0 is stored in `third`.
template <class V>
struct SquareRoot {
    template <int k>
    GRAZE_INLINE static void run(const KernelOperands& o, Order) {
        const V a = at<V>(o.left, k);
        if constexpr (k == 0) {
            const V root = evaluate<Operation::sqrt>(a);
            put(o.third, 0, Numbers<V>::of(0.5) / root);
            put(o.result, 0, root);
        } else {
            const V slope = at<V>(o.third, 0);
            if constexpr (k == 1)
                put(o.result, k, a * slope);
            else
                put(o.result, k, multiply_add(a, slope, -(self_convolution<V, k>(o.result) * slope)));
        }
    }
};

/// a y' = c a' y; the reciprocal of a at order 0 is stored in `third`.
template <class V>
struct Power {
    template <int k>
    GRAZE_INLINE static void run(const KernelOperands& o, Order) {
        const V a = at<V>(o.left, k);
        const V exponent = at<V>(o.right, 0);
        if constexpr (k == 0) {
            put(o.third, 0, Numbers<V>::of(1) / a);
            put(o.result, 0, power(a, exponent));
        } else {
            const V reciprocal = at<V>(o.third, 0);
            const V slope = exponent * at<V>(o.result, 0) * reciprocal;
            if constexpr (k == 1) {
                put(o.result, k, slope * a);
            } else {
                const V more = exponent + Numbers<V>::of(1);
                put(o.result, k, multiply_add(a, slope, sum<k>(o, more) * reciprocal * inverse.of[k]));
            }
        }
    }

private:
    template <int k>
    GRAZE_INLINE static V sum(const KernelOperands& o, V more) {
        if constexpr (in_loop<k, k - 1>) {
            return long_sum(o, more, k);
        } else {
            V sums[4];
            [&]<int... j>(Indices<j...>) __attribute__((always_inline)) {
                (accumulate<j>(sums, weighted(o, more, k, j), at<V>(o.result, k - 1 - j)), ...);
            }
            (std::make_integer_sequence<int, k - 1>{});
            return total<k - 1>(sums);
        }
    }
    [[gnu::noinline]] static V long_sum(const KernelOperands& o, V more, Order k) {
        return sum_in_loop<V>(
            k - 1, [&](Order j) __attribute__((always_inline)) {
                return Factors<V>{weighted(o, more, k, j), at<V>(o.result, k - 1 - j)};
            });
    }
    GRAZE_INLINE static V weighted(const KernelOperands& o, V more, Order k, Order j) {
        return multiply_add(more, Numbers<V>::of(double(j + 1)), Numbers<V>::of(double(-k))) * at<V>(o.left, j + 1);
    }
};

/// k y_k = sum of (j a_j) w_{k-j}, with the sign of the derivative; (j a_j) is in `left`, w in `right`, a in `third`.
template <class V, bool negative>
struct FunctionByProduct {
    template <int k>
    GRAZE_INLINE static void run(const KernelOperands& o, Order) {
        const V a = at<V>(o.third, k);
        const V w0 = negative ? -at<V>(o.right, 0) : at<V>(o.right, 0);
        if constexpr (k == 1)
            put(o.result, k, a * w0);
        else
            put(o.result, k,
                multiply_add(a, w0, convolution<V, k>(o.left, o.right) * (negative ? -inverse.of[k] : inverse.of[k])));
    }
};

/// The same where a_j = 0 for j > 1.
template <class V, bool negative>
GRAZE_INLINE void function_of_linear(const KernelOperands& o, Order k) {
    put(o.result, k, at<V>(o.right, k - 1) * (at<V>(o.third, 1) * (negative ? -inverse.of[k] : inverse.of[k])));
}

/// All coefficients of two such functions, each of which is the w of the other (sin and cos, sinh and cosh).
template <class V, bool negative>
GRAZE_INLINE void whole_pair(const KernelOperands& o, Order highest) {
    const V slope = at<V>(o.left, 1);
    V one = at<V>(o.result, 1), other = at<V>(o.third, 1);
    for (Order k = 2; k <= highest; ++k) {
        const V next = other * (slope * inverse.of[k]);
        other = one * (slope * (negative ? -inverse.of[k] : inverse.of[k]));
        one = next;
        put(o.result, k, one);
        put(o.third, k, other);
    }
}

/// All coefficients of such a function that is its own w (exp).
template <class V>
GRAZE_INLINE void whole_exponential(const KernelOperands& o, Order highest) {
    const V slope = at<V>(o.left, 1);
    V value = at<V>(o.result, 1);
    for (Order k = 2; k <= highest; ++k)
        value = put(o.result, k, value * (slope * inverse.of[k]));
}

/// k y_k, found in `left`, divided by k, with a sign.
template <class V, bool negative>
struct FunctionByQuotient {
    template <int k>
    GRAZE_INLINE static void run(const KernelOperands& o, Order) {
        put(o.result, k, at<V>(o.left, k) * (negative ? -inverse.of[k] : inverse.of[k]));
    }
};

template <class V>
struct Derivative {
    template <int k>
    GRAZE_INLINE static void run(const KernelOperands& o, Order) {
        put(o.result, k, k == 0 ? Numbers<V>::of(0) : at<V>(o.left, k) * double(k));
    }
};

template <class V, Operation function>
GRAZE_INLINE void function_value(const KernelOperands& o, Order) {
    put(o.result, 0, evaluate<function>(at<V>(o.third, 0)));
}

/// Compilers combine the two into one call of the library.
template <class V>
GRAZE_INLINE void sine_and_cosine(const KernelOperands& o, Order) {
    const V a = at<V>(o.left, 0);
    V sine, cosine;
    evaluate_sine_and_cosine(a, sine, cosine);
    put(o.result, 0, sine);
    put(o.third, 0, cosine);
}

template <class V>
GRAZE_INLINE void multiply_linear(const KernelOperands& o, Order k) {
    put(o.result, k, multiply_add(at<V>(o.left, 0), at<V>(o.right, k), at<V>(o.left, 1) * at<V>(o.right, k - 1)));
}

/// Numbers at one order.
template <class V>
struct OneOrder {
    GRAZE_INLINE static V zero() { return Numbers<V>::of(0); }
    GRAZE_INLINE static V coefficient(const double* from) { return at<V>(from, 0); }
    GRAZE_INLINE static V term(const double* series, Order k) { return at<V>(series, k); }
};
/// Numbers of one lane at as many consecutive orders as a register holds.
struct ManyOrders {
    GRAZE_INLINE static Pack zero() { return splat(0); }
    GRAZE_INLINE static Pack coefficient(const double* from) { return splat(*from); }
    GRAZE_INLINE static Pack term(const double* series, Order k) {
        Pack terms;
        __builtin_memcpy(&terms, series + k, sizeof(Pack));
        return terms;
    }
};

/// Returns the sum of coefficient times series; terms that become ready last are added last.
/// @tparam count number of terms; 0: any number
template <class At, int count>
GRAZE_INLINE auto combination(const KernelOperands& o, Order k) {
    const auto add = [k](const TermOperands& term, auto sum) __attribute__((always_inline)) {
        return multiply_add(At::coefficient(term.coefficient), At::term(term.series, k), sum);
    };
    if constexpr (count == 1) {
        return At::coefficient(o.third) * At::term(o.left, k);
    } else if constexpr (count > 1) {
        const TermOperands* terms = o.terms;
        auto sum = At::coefficient(terms[0].coefficient) * At::term(terms[0].series, k);
        for (int i = 1; i < count; ++i)
            sum = add(terms[i], sum);
        return sum;
    } else {
        const TermOperands* terms = o.terms;
        decltype(At::zero()) sums[4] = {At::zero(), At::zero(), At::zero(), At::zero()};
        for (; o.terms_end - terms >= 4; terms += 4)
            for (int i = 0; i < 4; ++i)
                sums[i] = add(terms[i], sums[i]);
        auto sum = total<4>(sums);
        for (; terms != o.terms_end; ++terms)
            sum = add(*terms, sum);
        return sum;
    }
}

template <class V, class At>
struct Combination {
    template <int count>
    GRAZE_INLINE static void run(const KernelOperands& o, Order k) {
        put(o.result, k, combination<At, count>(o, k));
    }
    template <int count>
    GRAZE_INLINE static void run_value(const KernelOperands& o, Order) {
        put(o.result, 0, combination<At, count>(o, 0) + at<V>(o.right, 0));
    }
    template <int count>
    GRAZE_INLINE static void run_whole(const KernelOperands& o, Order highest) {
        Order k = 2;
        if constexpr (Numbers<V>::width == 1)
            for (; k + lanes <= highest + 1; k += lanes) {
                const Pack sums = combination<ManyOrders, count>(o, k);
                __builtin_memcpy(o.result + k, &sums, sizeof(Pack));
            }
        for (; k <= highest; ++k)
            run<count>(o, k);
    }
};

template <class V, class At>
struct StateCombination {
    template <int count>
    GRAZE_INLINE static void run(const KernelOperands& o, Order k) {
        put(o.result, k, combination<At, count>(o, k - 1) * inverse.of[k]);
    }
    template <int count>
    GRAZE_INLINE static void run_value(const KernelOperands& o, Order) {
        put(o.result, 1, combination<At, count>(o, 0) + at<V>(o.right, 0));
    }
};

template <class V>
GRAZE_INLINE void state(const KernelOperands& o, Order k) {
    put(o.result, k, at<V>(o.left, k - 1) * inverse.of[k]);
}

// Two steps that often follow one another. Their operands are adjacent.

template <class V>
GRAZE_INLINE void two_states(const KernelOperands* operands, Order k) {
    const V one = at<V>(operands[0].left, k - 1), other = at<V>(operands[1].left, k - 1);
    put(operands[0].result, k, one * inverse.of[k]);
    put(operands[1].result, k, other * inverse.of[k]);
}

/// An operation, and a linear combination of its result alone.
template <class V, class Family>
struct WithMultiple {
    template <int k>
    GRAZE_INLINE static void run(const KernelOperands* operands, Order order) {
        const V result = Family::template run<k>(operands[0], order);
        put(operands[1].result, k, at<V>(operands[1].third, 0) * result);
    }
};

template <class V>
struct DivideCombination {
    template <int k>
    GRAZE_INLINE static void run(const KernelOperands* operands, Order) {
        const V sum = put(operands[0].result, k, combination<OneOrder<V>, 2>(operands[0], k));
        Divide<V>::template run_of<k>(operands[1], sum);
    }
};

template <class V>
void literal(double* result, double value) {
    put(result, 0, Numbers<V>::of(value));
}

/// Arithmetic on constants.
template <class V, Operation operation>
GRAZE_INLINE void constant(const KernelOperands& o, Order) {
    const V a = at<V>(o.left, 0);
    if constexpr (operation == Operation::add)
        put(o.result, 0, a + at<V>(o.right, 0));
    else if constexpr (operation == Operation::subtract)
        put(o.result, 0, a - at<V>(o.right, 0));
    else if constexpr (operation == Operation::multiply)
        put(o.result, 0, a * at<V>(o.right, 0));
    else if constexpr (operation == Operation::divide)
        put(o.result, 0, a / at<V>(o.right, 0));
    else if constexpr (operation == Operation::power)
        put(o.result, 0, power(a, at<V>(o.right, 0)));
    else
        put(o.result, 0, evaluate<operation>(a));
}

} // namespace graze::GRAZE_INSTRUCTION_SET
