#pragma once

// The first variational equations along one motion, for one direction or several side by side. The series of the motion
// have no lanes. To be included only by the translation unit of an instruction set.

#include "tape/kernels.hpp"
#include "tape/sum_kernels.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {

GRAZE_INLINE unsigned lanes_above(double a, double b) {
    return a <= b ? 0U : 1U;
}
template <int n>
GRAZE_INLINE unsigned lanes_above(Packs<n> a, Packs<n> b) {
    unsigned bits = 0;
    for (int i = 0; i < n; ++i)
        bits |= lanes_above(a.part[i], b.part[i]) << (i * lanes);
    return bits;
}

/// Sums a row's coefficient of order k in several parts that do not wait for each other. All orders share this code:
/// unrolled code for each order would evict other code of the step from the instruction cache.
template <class V>
class TangentSum {
public:
    GRAZE_INLINE TangentSum() {
        for (V& part : parts_)
            part = Numbers<V>::of(0);
    }
    GRAZE_INLINE void add(double a, V w) { add_to<0>(a, w); }
    GRAZE_INLINE void add_beside(double a, V w) { add_to<1>(a, w); }
    /// Adds the terms a_j w_{k-j}, j = 0 .. k.
    GRAZE_INLINE void add_all(const double* a, const double* w, int k) {
        constexpr std::ptrdiff_t width = Numbers<V>::width;
        w += k * width;
        int left = k + 1;
        for (; left >= 4; left -= 4, a += 4, w -= 4 * width) {
            add_to<0>(a[0], Numbers<V>::load(w));
            add_to<1>(a[1], Numbers<V>::load(w - width));
            add_to<2>(a[2], Numbers<V>::load(w - 2 * width));
            add_to<3>(a[3], Numbers<V>::load(w - 3 * width));
        }
        if ((left & 2) != 0) {
            add_to<0>(a[0], Numbers<V>::load(w));
            add_to<1>(a[1], Numbers<V>::load(w - width));
            a += 2;
            w -= 2 * width;
        }
        if ((left & 1) != 0)
            add_to<2>(a[0], Numbers<V>::load(w));
    }
    /// Returns the total when only products of single coefficients have been added.
    GRAZE_INLINE V total_of_few() const { return parts_[0] + parts_[1]; }
    GRAZE_INLINE V total() const { return (parts_[0] + parts_[1]) + (parts_[2] + parts_[3]); }

private:
    template <int part>
    GRAZE_INLINE void add_to(double a, V w) {
        parts_[part] = multiply_add(Factor{splat(a)}, w, parts_[part]);
    }
    V parts_[4];
};

/// The same for one direction, where coefficients are contiguous.
template <>
class TangentSum<double> {
public:
    GRAZE_INLINE void add(double a, double w) { sums_[0] = multiply_add(a, w, sums_[0]); }
    GRAZE_INLINE void add_beside(double a, double w) { sums_[1] = multiply_add(a, w, sums_[1]); }
    GRAZE_INLINE void add_all(const double* a, const double* w, int k) {
        // The newest coefficient is added separately: it is still in the store buffer, from which a load of four would
        // stall.
        sums_[0] = multiply_add(a[0], w[k], sums_[0]);
        int j = 1;
#if defined(__FMA__)
        for (; j + 3 <= k; j += 4)
            add_four(a + j, w + k - j - 3);
#endif
        for (; j < k; j += 2) {
            sums_[1] = multiply_add(a[j], w[k - j], sums_[1]);
            sums_[0] = multiply_add(a[j + 1], w[k - j - 1], sums_[0]);
        }
        if (j == k)
            sums_[1] = multiply_add(a[j], w[0], sums_[1]);
    }
    GRAZE_INLINE double total_of_few() const {
        return sums_[0] + sums_[1];
    }
    GRAZE_INLINE double total() const {
#if defined(__FMA__)
        const __m128d halves = _mm256_castpd256_pd128(four_) + _mm256_extractf128_pd(four_, 1);
        return (sums_[0] + sums_[1]) + (halves[0] + halves[1]);
#else
        return sums_[0] + sums_[1];
#endif
    }

private:
#if defined(__FMA__)
    /// @param w points to the last of the four
    GRAZE_INLINE void add_four(const double* a, const double* w) {
        four_ = _mm256_fmadd_pd(_mm256_loadu_pd(a), _mm256_permute4x64_pd(_mm256_loadu_pd(w), 0x1b), four_);
    }
    __m256d four_ = _mm256_setzero_pd();
#endif
    double sums_[2] = {0, 0};
};

/// Computes coefficient k of an intermediate quantity, or k + 1 of a state.
template <class V>
GRAZE_INLINE void tangent_row(const TangentRow& row, double* numbers, const double* jet, int k) {
    TangentSum<V> sum;
    const TangentTerm* term = row.fixed;
    for (; row.still - term >= 2; term += 2) {
        sum.add(jet[term[0].series], at<V>(numbers + term[0].source, k));
        sum.add_beside(jet[term[1].series], at<V>(numbers + term[1].source, k));
    }
    if (term != row.still) {
        sum.add(jet[term->series], at<V>(numbers + term->source, k));
        ++term;
    }
    for (; term != row.few; ++term)
        sum.add_beside(jet[term->series + k], at<V>(numbers + term->source, 0));
    for (; term != row.many; ++term) {
        const int last = term->degree < k ? term->degree : k;
        for (int j = k > term->source_degree ? k - term->source_degree : 0; j <= last; ++j)
            sum.add(jet[term->series + j], at<V>(numbers + term->source, k - j));
    }
    V change;
    if (term == row.end) {
        change = sum.total_of_few();
    } else {
        for (; term != row.end; ++term)
            sum.add_all(jet + term->series, numbers + term->source, k);
        change = sum.total();
    }
    if (row.is_rate)
        put(numbers + row.result, k + 1, change * inverse.of[k + 1]);
    else
        put(numbers + row.result, k, change);
}

template <class V>
void tangent_orders(const TangentOperands& o, const double* jet, int order) {
    for (int k = 0; k < order; ++k) {
        const bool all = k <= low_degree;
        const TangentRow* const end = all ? o.end : o.lasting_end;
        for (const TangentRow* row = all ? o.begin : o.lasting; row != end; ++row)
            tangent_row<V>(*row, o.numbers, jet, k);
    }
}

/// Returns the ratio, or 0 where the size is too small for it to be meaningful.
GRAZE_INLINE double share_of(double last, double size) {
    return size > smallest_derivative ? last / size : 0;
}
template <int n>
GRAZE_INLINE Packs<n> share_of(Packs<n> last, Packs<n> size) {
    return GRAZE_FOR_PARTS(Packs<n>, size.part[i] > smallest_derivative ? last.part[i] / size.part[i] : splat(0));
}
/// Returns the ratio of the last two terms to the sum of all sizes, in lanes where the first three terms are zero.
template <class V>
GRAZE_INLINE double share_of_all(const double* c, int order, double step, V last, V size) {
    constexpr int width = Numbers<V>::width;
    double sizes[width], lasts[width], worst = 0;
    Numbers<V>::store(sizes, size);
    Numbers<V>::store(lasts, last);
    for (int lane = 0; lane < width; ++lane) {
        if (!(lasts[lane] > 0) || sizes[lane] > 0)
            continue;
        double all = 0;
        for (int k = order; k >= 0; --k)
            all = all * step + absolute(c[k * width + lane]);
        worst = greater(worst, share_of(lasts[lane], all));
    }
    return worst;
}

template <class V>
double tangent_tails(const TangentStates& states, double step, const double* floors) {
    constexpr int width = Numbers<V>::width;
    const int order = states.order;
    double power = 1, worst_of_all = 0;
    for (int k = 1; k < order; ++k)
        power *= step;
    V worst = Numbers<V>::of(0);
    for (const std::size_t* state = states.followed; state != states.followed_end; ++state) {
        const std::size_t i = *state;
        const double* c = states.numbers + i * states.size;
        V size = absolute(at<V>(c, 0)) + (absolute(at<V>(c, 1)) + absolute(at<V>(c, 2)) * step) * step;
        if (floors != nullptr)
            size = greater(size, Numbers<V>::load(floors + i * static_cast<std::size_t>(width)));
        const V last = greater(absolute(at<V>(c, order - 1)), absolute(at<V>(c, order)) * step) * power;
        worst = greater(worst, share_of(last, size));
        if (lanes_above(last, size * 0x1p+1000) != 0) // where the size is zero
            worst_of_all = greater(worst_of_all, share_of_all(c, order, step, last, size));
    }
    double shares[width];
    Numbers<V>::store(shares, worst);
    for (const double share : shares)
        worst_of_all = greater(worst_of_all, share);
    return worst_of_all;
}

template <class V>
std::size_t tangent_misfit(const TangentStates& states, const TangentEnds& ends, std::size_t from) {
    constexpr std::size_t width = Numbers<V>::width;
    const unsigned in_use = (1U << states.count) - 1U;
    for (std::size_t i = from; i < states.states; ++i) {
        const double* c = states.numbers + i * states.size;
        const V rate = at<V>(ends.there + i * states.size, 1), end = Numbers<V>::load(ends.sums + i * width);
        const V size = Numbers<V>::of(ends.smallest) + greater(absolute(at<V>(c, 0)), absolute(end)) +
                       greater(absolute(at<V>(c, 1)), absolute(rate)) * (0.25 * ends.length);
        const V apart = absolute(Numbers<V>::load(ends.slopes + i * width) - rate) * ends.length;
        if ((lanes_above(apart, size * ends.allowed) & in_use) != 0)
            return i;
    }
    return states.states;
}

template <class V>
constexpr TangentKernels make_tangent_kernels() {
    TangentKernels kernels{};
    kernels.width = Numbers<V>::width;
    kernels.compute = &tangent_orders<V>;
    kernels.sums_and_slopes = &sums_and_slopes<V>;
    kernels.tails = &tangent_tails<V>;
    kernels.misfit = &tangent_misfit<V>;
    return kernels;
}

} // namespace graze::GRAZE_INSTRUCTION_SET
