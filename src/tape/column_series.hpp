#pragma once

#include "graze/tape/jet.hpp"
#include "graze/tape/series.hpp"
#include "tape/aligned_numbers.hpp"
#include "tape/kernel_table.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// An entry of a matrix A along a flow that is not zero throughout.
struct MatrixEntry {
    std::size_t row = 0, column = 0;
    std::size_t output = 0; ///< of the flow's tape, whose series it is
};

/// Taylor coefficients of a matrix W with W' = A W along a flow, in the lanes of an ensemble: of the first variational
/// equations where A is the field's Jacobian. The entries of A are outputs of the flow's jets. Each is computed once,
/// however many columns there are, and products are summed in registers: all that columns touch, one order after
/// another, is A and W.
class ColumnSeries {
public:
    /// @param jet an ensemble jet of this tape and instruction set, whose outputs are read whenever columns are
    /// computed: it must stay where it is
    /// @param entries by rising row; @param rows of W, and so columns of A; @param columns of W
    /// @throws InputError for entries that are out of range or not in order
    ColumnSeries(const Jet& jet, const Tape& tape, std::span<const MatrixEntry> entries, std::size_t rows,
                 std::size_t columns, InstructionSet set = best_instruction_set());
    ColumnSeries(const ColumnSeries&) = delete; // terms point to each other
    ColumnSeries& operator=(const ColumnSeries&) = delete;

    /// From where W is now, [(column * rows + row) * width + lane], once the jet has been computed.
    void compute(std::span<const double> start) { compute(start, order_); }
    /// Coefficients 0 and 1 alone, for which the jet need only have been begun.
    void begin(std::span<const double> start) { compute(start, 1); }
    /// The first lane of all entries, column by column.
    std::span<const Series> series() const { return series_; }
    /// Sums of the series and of their derivatives, in each lane at its own time, laid out as the start.
    void evaluate(std::span<const double> times, std::span<double> values, std::span<double> slopes) const;
    /// The largest share, of all columns, that the last two terms have at a length of time in the column's first three.
    /// @param lengths [lane]; @param scales of the rows, in units of which the largest counts; @param worst [lane]
    void tails(std::span<const double> lengths, std::span<const double> scales, std::span<double> worst) const;
    /// By how much slopes at ends of steps differ from what the equations say there, as far as a column's largest
    /// differences, sizes and rates go (those of StepCheck::size_over), in units of what is allowed; infinity where
    /// something is not finite.
    /// @param end columns of another jet of the same tape, begun at the ends with `values`; @param values, slopes as
    /// from `evaluate`; @param allowance the share of rates, and what is added to sizes
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
