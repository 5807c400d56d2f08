#pragma once

// The numbers that kernels compute with. To be included only by the translation unit of one instruction set, which
// defines GRAZE_INSTRUCTION_SET (the namespace, so that no two sets share a function) and GRAZE_LANES.
// Arithmetic on values is the same operation by operation for all three types: this makes lanes agree bit for bit.

#include "graze/symbolic/expression.hpp"

#include <math.h>
#if defined(__AVX512F__) || defined(__FMA__)
#include <immintrin.h>
#endif

// Kernels are long because loops are unrolled; left alone, compilers would not inline what they are made of.
#define GRAZE_INLINE [[gnu::always_inline]] inline

namespace graze::GRAZE_INSTRUCTION_SET {

inline constexpr int lanes = GRAZE_LANES;
typedef double Pack __attribute__((vector_size(8 * lanes)));

/// Independent lanes.
struct Ensemble {
    Pack values;
};
/// A number and its derivatives in some directions.
struct Tangent {
    double value;
    Pack directions;
};

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
    return Pack{} + value;
}

GRAZE_INLINE Ensemble operator+(Ensemble a, Ensemble b) {
    return {a.values + b.values};
}
GRAZE_INLINE Ensemble operator-(Ensemble a, Ensemble b) {
    return {a.values - b.values};
}
GRAZE_INLINE Ensemble operator-(Ensemble a) {
    return {-a.values};
}
GRAZE_INLINE Ensemble operator*(Ensemble a, Ensemble b) {
    return {a.values * b.values};
}
GRAZE_INLINE Ensemble operator*(Ensemble a, double b) {
    return {a.values * b};
}
GRAZE_INLINE Ensemble operator/(Ensemble a, Ensemble b) {
    return {a.values / b.values};
}
GRAZE_INLINE Ensemble multiply_add(Ensemble a, Ensemble b, Ensemble c) {
    return {multiply_add(a.values, b.values, c.values)};
}

GRAZE_INLINE Tangent operator+(Tangent a, Tangent b) {
    return {a.value + b.value, a.directions + b.directions};
}
GRAZE_INLINE Tangent operator-(Tangent a, Tangent b) {
    return {a.value - b.value, a.directions - b.directions};
}
GRAZE_INLINE Tangent operator-(Tangent a) {
    return {-a.value, -a.directions};
}
GRAZE_INLINE Tangent operator*(Tangent a, Tangent b) {
    return {a.value * b.value, multiply_add(splat(a.value), b.directions, splat(b.value) * a.directions)};
}
GRAZE_INLINE Tangent operator*(Tangent a, double b) {
    return {a.value * b, a.directions * b};
}
GRAZE_INLINE Tangent operator/(Tangent a, Tangent b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.directions - quotient * b.directions) / b.value};
}
GRAZE_INLINE Tangent multiply_add(Tangent a, Tangent b, Tangent c) {
    return {multiply_add(a.value, b.value, c.value),
            multiply_add(splat(a.value), b.directions, multiply_add(a.directions, splat(b.value), c.directions))};
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

template <>
struct Numbers<Ensemble> {
    static constexpr int width = lanes;
    GRAZE_INLINE static Ensemble load(const double* from) {
        Ensemble number;
        __builtin_memcpy(&number.values, from, sizeof(Pack));
        return number;
    }
    GRAZE_INLINE static void store(double* to, Ensemble number) { __builtin_memcpy(to, &number.values, sizeof(Pack)); }
    GRAZE_INLINE static Ensemble of(double number) { return {splat(number)}; }
};

template <>
struct Numbers<Tangent> {
    static constexpr int width = 1 + lanes;
    GRAZE_INLINE static Tangent load(const double* from) {
        Tangent number;
        number.value = *from;
        __builtin_memcpy(&number.directions, from + 1, sizeof(Pack));
        return number;
    }
    GRAZE_INLINE static void store(double* to, Tangent number) {
        *to = number.value;
        __builtin_memcpy(to + 1, &number.directions, sizeof(Pack));
    }
    GRAZE_INLINE static Tangent of(double number) { return {number, Pack{}}; }
};

/// Coefficient of a series.
template <class V>
GRAZE_INLINE V at(const double* series, int order) {
    return Numbers<V>::load(series + order * Numbers<V>::width);
}
template <class V>
GRAZE_INLINE void put(double* series, int order, V number) {
    Numbers<V>::store(series + order * Numbers<V>::width, number);
}

template <Operation function>
inline double value_of(double a) {
    if constexpr (function == Operation::negate)
        return -a;
    else if constexpr (function == Operation::sqrt)
        return ::sqrt(a);
    else if constexpr (function == Operation::exp)
        return ::exp(a);
    else if constexpr (function == Operation::log)
        return ::log(a);
    else if constexpr (function == Operation::sin)
        return ::sin(a);
    else if constexpr (function == Operation::cos)
        return ::cos(a);
    else if constexpr (function == Operation::tan)
        return ::tan(a);
    else if constexpr (function == Operation::asin)
        return ::asin(a);
    else if constexpr (function == Operation::acos)
        return ::acos(a);
    else if constexpr (function == Operation::atan)
        return ::atan(a);
    else if constexpr (function == Operation::sinh)
        return ::sinh(a);
    else if constexpr (function == Operation::cosh)
        return ::cosh(a);
    else {
        static_assert(function == Operation::tanh);
        return ::tanh(a);
    }
}

/// Derivative of a function at a, where its value is y.
template <Operation function>
inline double slope_of(double a, double y) {
    if constexpr (function == Operation::negate)
        return -1;
    else if constexpr (function == Operation::sqrt)
        return 0.5 / y;
    else if constexpr (function == Operation::exp)
        return y;
    else if constexpr (function == Operation::log)
        return 1 / a;
    else if constexpr (function == Operation::sin)
        return ::cos(a);
    else if constexpr (function == Operation::cos)
        return -::sin(a);
    else if constexpr (function == Operation::tan)
        return 1 + y * y;
    else if constexpr (function == Operation::asin)
        return 1 / ::sqrt((1 - a) * (1 + a));
    else if constexpr (function == Operation::acos)
        return -1 / ::sqrt((1 - a) * (1 + a));
    else if constexpr (function == Operation::atan)
        return 1 / (1 + a * a);
    else if constexpr (function == Operation::sinh)
        return ::cosh(a);
    else if constexpr (function == Operation::cosh)
        return ::sinh(a);
    else {
        static_assert(function == Operation::tanh);
        return (1 - y) * (1 + y);
    }
}

/// slope * directions, but 0 in a direction in which nothing changes even where the slope is infinite.
inline Pack along(double slope, Pack directions) {
    Pack result;
    for (int lane = 0; lane < lanes; ++lane)
        result[lane] = directions[lane] == 0 ? 0.0 : slope * directions[lane];
    return result;
}

template <Operation function>
inline double evaluate(double a) {
    return value_of<function>(a);
}
template <Operation function>
inline Ensemble evaluate(Ensemble a) {
    for (int lane = 0; lane < lanes; ++lane)
        a.values[lane] = value_of<function>(a.values[lane]);
    return a;
}
template <Operation function>
inline Tangent evaluate(Tangent a) {
    const double value = value_of<function>(a.value);
    return {value, along(slope_of<function>(a.value, value), a.directions)};
}

inline double power(double a, double exponent) {
    return ::pow(a, exponent);
}
inline Ensemble power(Ensemble a, Ensemble exponent) {
    for (int lane = 0; lane < lanes; ++lane)
        a.values[lane] = ::pow(a.values[lane], exponent.values[lane]);
    return a;
}
inline Tangent power(Tangent a, Tangent exponent) {
    const double value = ::pow(a.value, exponent.value);
    return {value, along(exponent.value * ::pow(a.value, exponent.value - 1), a.directions) +
                       along(value == 0 ? 0.0 : value * ::log(a.value), exponent.directions)};
}

} // namespace graze::GRAZE_INSTRUCTION_SET
