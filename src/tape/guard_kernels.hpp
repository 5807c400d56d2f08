#pragma once

// Step limits from intermediate series that the states and outputs do not show: far from a steep place, the terms of
// exp(-(30 x)^2) or 1/(x^2 + 1e-12) are lost in a sum with 1. To be included only by the translation unit of an
// instruction set.

#include "tape/kernel_table.hpp"
#include "tape/step_kernels.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {

/// Size of coefficient k in a lane.
inline double size_of(const Series& series, int k, int lane) {
    return __builtin_fabs(series.first[static_cast<std::size_t>(k) * series.stride + static_cast<std::size_t>(lane)]);
}

/// Returns how far an argument may change from its value at the start. Where the function is constant to the last
/// digit, up to where it becomes visible; from there on the function's own coefficients limit the step.
inline double allowed_change(const GuardedArgument& argument, int order, int lane) {
    constexpr double exponential_seen = 40, tangent_seen = 17, tangent_constant = 19, exponential_vanishes = -800;
    const double now = argument.series.first[lane], size = __builtin_fabs(now);
    const double usual = argument.absolute + size * argument.relative;
    switch (argument.kind) {
    case GuardKind::exponential:
        // The exponential is zero, but its argument's coefficients overflow.
        if (now < exponential_vanishes && !(size_of(argument.series, order, lane) < __builtin_inf()))
            return __builtin_inf();
        return greater(usual, -now - exponential_seen);
    case GuardKind::hyperbolic_tangent:
        return size > tangent_constant ? size - tangent_seen : usual;
    case GuardKind::power:
        return greater(usual, argument.seen - size);
    default:
        return usual;
    }
}

/// Shortens the step of one lane, if it is finite, until its guards allow it.
inline double guarded(const Guards& guards, int order, int lane, double step) {
    if (!(step < __builtin_inf()))
        return step;
    for (std::size_t i = 0; i < guards.argument_count; ++i) {
        const Series& series = guards.arguments[i].series;
        const double allowed = allowed_change(guards.arguments[i], order, lane);
        if (!(allowed < __builtin_inf()))
            continue;
        for (int sweep = 0; sweep < 100; ++sweep) {
            double change = 0;
            for (int k = order; k > 0; --k)
                change = (change + size_of(series, k, lane)) * step;
            if (!(change > allowed))
                break;
            // The highest power alone would ask for the second factor at most, so that few iterations are needed.
            const double ratio = allowed / change;
            step *= change < 1e300 ? greater(0.99 * ::pow(ratio, 1.0 / order), 0.9 * ratio) : 0.1;
        }
    }
    for (std::size_t i = 0; i < guards.quotient_count; ++i) {
        const Series& series = guards.quotients[i];
        for (int sweep = 0; sweep < 100; ++sweep) {
            const double last = greater(size_of(series, order, lane) * step, size_of(series, order - 1, lane)) *
                                integer_power(step, order - 1);
            double size =
                size_of(series, 0, lane) + step * (size_of(series, 1, lane) + step * size_of(series, 2, lane));
            if (size == 0) { // the series starts from zero: use all terms
                for (int k = order; k > 0; --k)
                    size = (size + size_of(series, k, lane)) * step;
            }
            if (!(last > size * largest_share.of[order - 1]) || last < smallest_size)
                break;
            step *= last < 1e300 ? 0.99 * ::pow(size * largest_share.of[order - 1] / last, 1.0 / (order - 1)) : 0.1;
        }
    }
    return step;
}

/// Shortens steps that are too long. A test of all lanes at once first excludes the usual case that none is.
template <class V>
void guard(const Guards& guards, int order, double* steps) {
    const V step = Numbers<V>::load(steps);
    double excess[Numbers<V>::width];
    V most = number<V>(0);
    const auto at = [](const Series& series, int k) __attribute__((always_inline)) {
        return absolute(Numbers<V>::load(series.first + static_cast<std::size_t>(k) * Numbers<V>::width));
    };
    for (std::size_t i = 0; i < guards.argument_count; ++i) {
        const GuardedArgument& argument = guards.arguments[i];
        V change = at(argument.series, order);
        for (int k = order; k-- > 1;)
            change = multiply_add(change, step, at(argument.series, k));
        const V allowed = at(argument.series, 0) * argument.relative + number<V>(argument.absolute);
        most = greater(most, multiply_add(change, step, -allowed));
    }
    if (guards.quotient_count > 0) {
        const V power = integer_power(step, order - 1);
        for (std::size_t i = 0; i < guards.quotient_count; ++i) {
            const Series& series = guards.quotients[i];
            const V last = greater(at(series, order) * step, at(series, order - 1)) * power;
            // A lower bound of the size is enough here: `guarded` decides.
            most = greater(most, last - at(series, 0) * largest_share.of[order - 1]);
        }
    }
    Numbers<V>::store(excess, most);
    for (int lane = 0; lane < Numbers<V>::width; ++lane)
        if (!(excess[lane] <= 0))
            steps[lane] = guarded(guards, order, lane, steps[lane]);
}

} // namespace graze::GRAZE_INSTRUCTION_SET
