#pragma once

// Series of the columns of a matrix W with W' = A W. To be included only by the translation unit of an instruction set.

#include "tape/kernels.hpp"
#include "tape/sum_kernels.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {

/// Columns computed together: they share each load of a coefficient of A and hide the latency of additions.
inline constexpr std::size_t most_columns = 4;

/// Computes (k+1) w_{k+1} = sum over the row's entries and j <= k of a_j w_{k-j} for `count` columns.
template <class V, std::size_t count>
GRAZE_INLINE void columns_from(const ColumnOperands& o, double* column, Order highest) {
    const std::size_t next_column = o.rows * o.size;
    for (Order k = 0; k < highest; ++k) {
        const ColumnTerm* term = o.terms;
        for (std::size_t row = 0; row < o.rows; ++row) {
            V sums[count];
            for (V& sum : sums)
                sum = Numbers<V>::of(0);
            for (; term != o.row_ends[row]; ++term) {
                const double* const factors = column + term->row * o.size;
                const Order last = k < term->degree ? k : term->degree;
                for (Order j = 0; j <= last; ++j) {
                    const V a = at<V>(term->series, j);
                    for (std::size_t d = 0; d < count; ++d)
                        sums[d] = multiply_add(a, at<V>(factors + d * next_column, k - j), sums[d]);
                }
            }
            for (std::size_t d = 0; d < count; ++d)
                put(column + d * next_column + row * o.size, k + 1, sums[d] * inverse.of[k + 1]);
        }
    }
}

template <class V>
void columns(const ColumnOperands& o, Order highest) {
    double* column = o.columns;
    for (std::size_t left = o.count; left > 0;) {
        const std::size_t now = left <= most_columns ? left : most_columns - 1; // avoids a last group of one column
        if (now == 1)
            columns_from<V, 1>(o, column, highest);
        else if (now == 2)
            columns_from<V, 2>(o, column, highest);
        else if (now == 3)
            columns_from<V, 3>(o, column, highest);
        else
            columns_from<V, 4>(o, column, highest);
        column += now * o.rows * o.size;
        left -= now;
    }
}

template <class V>
void column_tails(const ColumnOperands& o, Order highest, const double* lengths, const double* scales, double* worst) {
    const V length = Numbers<V>::load(lengths);
    V power = Numbers<V>::of(1), most = Numbers<V>::of(0);
    for (Order k = 1; k < highest; ++k)
        power = power * length;
    const double* c = o.columns;
    for (std::size_t d = 0; d < o.count; ++d) {
        V size = Numbers<V>::of(0), last = size;
        for (std::size_t row = 0; row < o.rows; ++row, c += o.size) {
            const double scale = 1 / scales[row];
            const V beginning =
                absolute(at<V>(c, 0)) + length * (absolute(at<V>(c, 1)) + length * absolute(at<V>(c, 2)));
            size = greater(size, beginning * scale);
            last =
                greater(last, greater(absolute(at<V>(c, highest - 1)), length * absolute(at<V>(c, highest))) * scale);
        }
        most = greater(most, power * last / size);
    }
    Numbers<V>::store(worst, most);
}

template <class V>
void column_misfit(const ColumnOperands& o, const ColumnEnds& ends, double* worst) {
    constexpr int width = Numbers<V>::width;
    const V length = Numbers<V>::load(ends.lengths);
    V most = Numbers<V>::of(0), sum = most;
    std::size_t entry = 0;
    for (std::size_t d = 0; d < o.count; ++d) {
        V size = Numbers<V>::of(0), apart = size;
        for (std::size_t row = 0; row < o.rows; ++row, ++entry) {
            const double *c = o.columns + entry * o.size, scale = 1 / ends.scales[row];
            const V rate = at<V>(ends.there + entry * o.size, 1);
            const V rates = greater(absolute(at<V>(c, 1)), absolute(rate)) * length;
            const V values = greater(absolute(at<V>(c, 0)), absolute(Numbers<V>::load(ends.values + entry * width)));
            const V difference = absolute(Numbers<V>::load(ends.slopes + entry * width) - rate) * length * scale;
            size = greater(size, (Numbers<V>::of(ends.smallest) + values + rates * 0.25) * scale);
            apart = greater(apart, difference);
            sum = sum + difference;
        }
        most = greater(most, apart / (size * ends.allowed));
    }
    double sums[width];
    Numbers<V>::store(worst, most);
    Numbers<V>::store(sums, sum * 0.0);
    for (int lane = 0; lane < width; ++lane)
        if (sums[lane] != 0)
            worst[lane] = __builtin_inf();
}

} // namespace graze::GRAZE_INSTRUCTION_SET
