#pragma once

// The number types of kernels. To be included only by the translation unit of one instruction set, which defines
// GRAZE_INSTRUCTION_SET (the namespace, so that no two sets share a function) and GRAZE_LANES. All types use the same
// operations in the same order: this makes lanes agree bit for bit.

#include "symbolic/function_table.hpp"

#include <cstddef>
#include <math.h>
#if defined(__AVX512F__) || defined(__FMA__)
#include <immintrin.h>
#endif

// Kernels are long because loops are unrolled; without this attribute compilers would not inline their parts.
#define GRAZE_INLINE [[gnu::always_inline]] inline

namespace graze::GRAZE_INSTRUCTION_SET {

inline constexpr int lanes = GRAZE_LANES;
typedef double Pack __attribute__((vector_size(8 * lanes)));

/// Several registers of independent lanes.
template <int count>
struct Packs {
    static constexpr int parts = count;
    Pack part[parts];
};
/// Independent trajectories. Two packs hide latency: the processor works on one while the other waits.
using Ensemble = Packs<2>;
GRAZE_INLINE double multiply_add(double a, double b, double c) {
#if defined(__FMA__)
    return __builtin_fma(a, b, c);
#else
    return a * b + c;
#endif
}

GRAZE_INLINE Pack multiply_add(Pack a, Pack b, Pack c) {
#if defined(__AVX512F__)
    static_assert(lanes == 8);
    return _mm512_fmadd_pd(a, b, c);
#elif defined(__FMA__)
    static_assert(lanes == 4);
    return _mm256_fmadd_pd(a, b, c);
#else
    return a * b + c;
#endif
}

GRAZE_INLINE Pack splat(double value) {
#if GRAZE_LANES == 8
    return Pack{value, value, value, value, value, value, value, value};
#elif GRAZE_LANES == 4
    return Pack{value, value, value, value};
#else
    return Pack{value, value};
#endif
}

/// Returns |a| by clearing the sign bits.
GRAZE_INLINE Pack absolute(Pack a) {
    typedef long long Bits __attribute__((vector_size(8 * lanes)));
    return __builtin_bit_cast(Pack, __builtin_bit_cast(Bits, a) & 0x7fffffffffffffff);
}
/// Returns the lanes where not a <= b, as bits.
GRAZE_INLINE unsigned lanes_above(Pack a, Pack b) {
#if defined(__AVX512F__)
    return _mm512_cmp_pd_mask(a, b, _CMP_NLE_UQ);
#elif defined(__FMA__)
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_NLE_UQ)));
#else
    unsigned bits = 0;
    for (int lane = 0; lane < lanes; ++lane)
        bits |= a[lane] <= b[lane] ? 0U : 1U << lane;
    return bits;
#endif
}

template <class V, class Function>
GRAZE_INLINE V for_parts(Function&& function) {
    V result;
    for (int i = 0; i < V::parts; ++i)
        result.part[i] = function(i);
    return result;
}
#define GRAZE_FOR_PARTS(V, expression) for_parts<V>([&](int i) __attribute__((always_inline)) { return expression; })

template <int n>
GRAZE_INLINE Packs<n> operator+(Packs<n> a, Packs<n> b) {
    return GRAZE_FOR_PARTS(Packs<n>, a.part[i] + b.part[i]);
}
template <int n>
GRAZE_INLINE Packs<n> operator-(Packs<n> a, Packs<n> b) {
    return GRAZE_FOR_PARTS(Packs<n>, a.part[i] - b.part[i]);
}
template <int n>
GRAZE_INLINE Packs<n> operator-(Packs<n> a) {
    return GRAZE_FOR_PARTS(Packs<n>, -a.part[i]);
}
template <int n>
GRAZE_INLINE Packs<n> operator*(Packs<n> a, Packs<n> b) {
    return GRAZE_FOR_PARTS(Packs<n>, a.part[i] * b.part[i]);
}
/// A number that is the same in all lanes.
struct Factor {
    Pack of;
};
template <int n>
GRAZE_INLINE Packs<n> operator*(Factor a, Packs<n> b) {
    return GRAZE_FOR_PARTS(Packs<n>, a.of * b.part[i]);
}
template <int n>
GRAZE_INLINE Packs<n> multiply_add(Factor a, Packs<n> b, Packs<n> c) {
    return GRAZE_FOR_PARTS(Packs<n>, multiply_add(a.of, b.part[i], c.part[i]));
}
template <int n>
GRAZE_INLINE Packs<n> operator*(Packs<n> a, double b) {
    return GRAZE_FOR_PARTS(Packs<n>, a.part[i] * b);
}
template <int n>
GRAZE_INLINE Packs<n> operator/(Packs<n> a, Packs<n> b) {
    return GRAZE_FOR_PARTS(Packs<n>, a.part[i] / b.part[i]);
}
template <int n>
GRAZE_INLINE Packs<n> multiply_add(Packs<n> a, Packs<n> b, Packs<n> c) {
    return GRAZE_FOR_PARTS(Packs<n>, multiply_add(a.part[i], b.part[i], c.part[i]));
}

template <class V>
struct Numbers;

template <>
struct Numbers<double> {
    static constexpr int width = 1;
    GRAZE_INLINE static double load(const double* from) { return *from; }
    GRAZE_INLINE static void store(double* to, double number) { *to = number; }
    GRAZE_INLINE static double of(double number) { return number; }
};

template <class V>
GRAZE_INLINE V load_parts(const double* from) {
    V number;
    for (std::ptrdiff_t i = 0; i < V::parts; ++i)
        __builtin_memcpy(&number.part[i], from + i * lanes, sizeof(Pack));
    return number;
}
template <class V>
GRAZE_INLINE void store_parts(double* to, V number) {
    for (std::ptrdiff_t i = 0; i < V::parts; ++i)
        __builtin_memcpy(to + i * lanes, &number.part[i], sizeof(Pack));
}

template <int n>
struct Numbers<Packs<n>> {
    static constexpr int width = n * lanes;
    GRAZE_INLINE static Packs<n> load(const double* from) { return load_parts<Packs<n>>(from); }
    GRAZE_INLINE static void store(double* to, Packs<n> number) { store_parts(to, number); }
    GRAZE_INLINE static Packs<n> of(double number) { return GRAZE_FOR_PARTS(Packs<n>, ((void)i, splat(number))); }
};

/// Loads a coefficient of a series.
template <class V>
GRAZE_INLINE V at(const double* series, std::ptrdiff_t order) {
    return Numbers<V>::load(series + order * Numbers<V>::width);
}
template <class V>
GRAZE_INLINE V put(double* series, std::ptrdiff_t order, V number) {
    Numbers<V>::store(series + order * Numbers<V>::width, number);
    return number;
}

template <Operation function>
inline double value_of(double a) {
#define GRAZE_ROW(name, recurrence, slope)                                                                             \
    if constexpr (function == Operation::name)                                                                         \
        return ::name(a);                                                                                              \
    else
    GRAZE_FUNCTIONS(GRAZE_ROW)
#undef GRAZE_ROW
    {
        static_assert(function == Operation::negate);
        return -a;
    }
}

template <Operation function>
inline double evaluate(double a) {
    return value_of<function>(a);
}
template <Operation function>
inline Ensemble evaluate(Ensemble a) {
    for (Pack& part : a.part)
        for (int lane = 0; lane < lanes; ++lane)
            part[lane] = value_of<function>(part[lane]);
    return a;
}
inline double power(double a, double exponent) {
    return ::pow(a, exponent);
}
inline Ensemble power(Ensemble a, Ensemble exponent) {
    for (int i = 0; i < Ensemble::parts; ++i)
        for (int lane = 0; lane < lanes; ++lane)
            a.part[i][lane] = ::pow(a.part[i][lane], exponent.part[i][lane]);
    return a;
}

} // namespace graze::GRAZE_INSTRUCTION_SET
