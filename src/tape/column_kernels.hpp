#pragma once

// Series of the columns of a matrix W with W' = A W. To be included only by the translation unit of an instruction set.

#include "tape/kernels.hpp"

namespace graze::GRAZE_INSTRUCTION_SET {

/// So many columns at once share each coefficient of A that is loaded, and hide the latency of additions.
inline constexpr std::size_t most_columns = 4;

/// (k+1) w_{k+1} = sum over the row's entries and j <= k of a_j w_{k-j}, for some columns from one on.
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
        const std::size_t now = left <= most_columns ? left : most_columns - 1; // none is left alone
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

} // namespace graze::GRAZE_INSTRUCTION_SET
