#pragma once

// What is asked of the derivatives in a tangent jet: all lanes are looked at together, and one by one only where they
// matter. To be included only by the translation unit of an instruction set.

#include "tape/sum_kernels.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {

template <int n>
GRAZE_INLINE unsigned lanes_above(Packs<n> a, Packs<n> b) {
    unsigned bits = 0;
    for (int i = 0; i < n; ++i)
        bits |= lanes_above(a.part[i], b.part[i]) << (i * lanes);
    return bits;
}
/// Bits of the lanes 1 .. count, which hold derivatives.
GRAZE_INLINE unsigned lanes_of_derivatives(int count) {
    return ((2U << count) - 1U) & ~1U;
}

template <class V>
double tangent_tails(const TangentStates& states, double step, const double* floors) {
    using L = Plain<V>;
    constexpr std::size_t width = Numbers<V>::width;
    const unsigned derivatives = lanes_of_derivatives(states.lanes);
    const int order = states.order;
    double power = 1, worst = 0;
    for (int k = 1; k < order; ++k)
        power *= step;
    for (std::size_t i = 0; i < states.count; ++i) {
        const double* c = states.series[i].first;
        L size = absolute(at<L>(c, 0)) + (absolute(at<L>(c, 1)) + absolute(at<L>(c, 2)) * step) * step;
        if (floors != nullptr)
            size = greater(size, Numbers<L>::load(floors + i * width));
        const L last = greater(absolute(at<L>(c, order - 1)), absolute(at<L>(c, order)) * step) * power;
        unsigned above = lanes_above(last, size * worst) & derivatives;
        if (above == 0)
            continue;
        double sizes[width], lasts[width];
        Numbers<L>::store(sizes, size);
        Numbers<L>::store(lasts, last);
        for (std::size_t lane = 1; lane <= static_cast<std::size_t>(states.lanes); ++lane) {
            if (lasts[lane] > 0 && !(sizes[lane] > 0)) {
                sizes[lane] = 0;
                for (int k = order; k >= 0; --k)
                    sizes[lane] = sizes[lane] * step + absolute(c[static_cast<std::size_t>(k) * width + lane]);
            }
            if (lasts[lane] > worst * sizes[lane] && sizes[lane] > smallest_derivative)
                worst = lasts[lane] / sizes[lane];
        }
    }
    return worst;
}

template <class V>
std::size_t tangent_misfit(const TangentStates& states, const TangentEnds& ends, std::size_t from) {
    using L = Plain<V>;
    constexpr std::size_t width = Numbers<V>::width;
    const unsigned derivatives = lanes_of_derivatives(states.lanes);
    for (std::size_t i = from; i < states.count; ++i) {
        const double* c = states.series[i].first;
        const L rate = at<L>(ends.there[i].first, 1), end = Numbers<L>::load(ends.sums + i * width);
        const L size = Numbers<L>::of(ends.smallest) + greater(absolute(at<L>(c, 0)), absolute(end)) +
                       greater(absolute(at<L>(c, 1)), absolute(rate)) * (0.25 * ends.length);
        const L apart = absolute(Numbers<L>::load(ends.slopes + i * width) - rate) * ends.length;
        if ((lanes_above(apart, size * ends.allowed) & derivatives) != 0)
            return i;
    }
    return states.count;
}

} // namespace graze::GRAZE_INSTRUCTION_SET
