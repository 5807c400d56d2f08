#pragma once

#include "graze/tape/jet.hpp"
#include "graze/tape/series.hpp"
#include "tape/aligned_numbers.hpp"
#include "tape/kernel_table.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// An entry of a matrix A along a flow that is not identically zero.
struct MatrixEntry {
    std::size_t row = 0, column = 0;
    std::size_t output = 0; ///< index of the entry among the outputs of the flow's tape
};

/// Taylor coefficients of a matrix W with W' = A W along a flow, in the lanes of an ensemble: the first variational
/// equations if A is the Jacobian of the field. The entries of A are outputs of the flow's jets, computed once for all
/// columns; products are summed in registers, so that the working set of an order is only A and W.
class ColumnSeries {
public:
    /// @param jet an ensemble jet of this tape and instruction set, whose outputs are read by each computation: it must
    /// outlive this object
    /// @param entries by rising row; @param rows of W, and so columns of A; @param columns of W
    /// @throws InputError for entries that are out of range or not in order
    ColumnSeries(const Jet& jet, const Tape& tape, std::span<const MatrixEntry> entries, std::size_t rows,
                 std::size_t columns, InstructionSet set = best_instruction_set());
    ColumnSeries(const ColumnSeries&) = delete; // terms point to each other
    ColumnSeries& operator=(const ColumnSeries&) = delete;

    /// Computes all coefficients from W at the start, [(column * rows + row) * width + lane], after the jet's
    /// `compute`.
    void compute(std::span<const double> start) { compute(start, order_); }
    /// Computes coefficients 0 and 1 only, for which the jet's `begin` is enough.
    void begin(std::span<const double> start) { compute(start, 1); }
    /// Series of lane 0 of all entries, column by column.
    std::span<const Series> series() const { return series_; }
    /// Evaluates the series and their derivatives, in each lane at its own time; laid out as `start`.
    void evaluate(std::span<const double> times, std::span<double> values, std::span<double> slopes) const;
    /// Returns per lane the largest ratio, over all columns, of the last two terms to the column's first three terms.
    /// @param lengths [lane] step lengths; @param scales [row] units of the rows; @param worst [lane] the result
    void tails(std::span<const double> lengths, std::span<const double> scales, std::span<double> worst) const;
    /// Returns per lane by how much the slopes at the ends of steps differ from the equations there, relative to the
    /// allowance; infinity where a number is not finite. Each column is judged by its largest difference, size and rate
    /// (as in StepCheck::size_over).
    /// @param end columns of another jet of the same tape, after `begin` at the ends with `values`
    /// @param values, slopes as from `evaluate`; @param allowance its tolerance of rates and its smallest size are used
    void misfit(const ColumnSeries& end, const EndAllowance& allowance, std::span<const double> lengths,
                std::span<const double> scales, std::span<const double> values, std::span<const double> slopes,
                std::span<double> worst) const;

private:
    void require_lanes(std::span<const double> numbers) const;
    void require_entries(std::span<const double> numbers) const;
    void require_rows(std::span<const double> numbers) const;
    void compute(std::span<const double> start, int highest);

    const KernelTable& table_;
    int order_;
    std::size_t width_;
    std::vector<ColumnTerm> terms_;
    std::vector<const ColumnTerm*> row_ends_;
    std::size_t size_; ///< numbers in a series
    AlignedNumbers numbers_;
    std::vector<Series> series_;
    std::vector<int> degrees_; ///< of all series
    ColumnOperands operands_{};
};

} // namespace graze
