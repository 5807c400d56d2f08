#include "tape/column_series.hpp"

#include "graze/base/require.hpp"

#include <algorithm>

namespace graze {

ColumnSeries::ColumnSeries(const Jet& jet, const Tape& tape, std::span<const MatrixEntry> entries, std::size_t rows,
                           std::size_t columns, InstructionSet set)
    : table_(kernel_table(LaneKind::ensemble, set)), order_(jet.order()), width_(static_cast<std::size_t>(jet.width())),
      row_ends_(rows), size_((static_cast<std::size_t>(order_) + 1) * width_), numbers_(rows * columns * size_),
      degrees_(rows * columns, order_) {
    require_size(width_, static_cast<std::size_t>(table_.width), "lanes of a jet");
    const auto order = static_cast<std::uint32_t>(order_);
    terms_.reserve(entries.size()); // ends of rows point to them
    std::size_t row = 0;
    for (const MatrixEntry& entry : entries) {
        require_index(entry.row, rows, "row");
        require_index(entry.column, rows, "column");
        require_index(entry.output, tape.outputs.size(), "output");
        require_room(entry.row, row, "row of the entry before");
        for (; row < entry.row; ++row)
            row_ends_[row] = terms_.data() + terms_.size();
        const Tape::Location& at = tape.outputs[entry.output];
        const std::uint32_t degree = at.constant ? 0 : std::min(tape.degrees[at.index], order);
        terms_.push_back({jet.output(entry.output), static_cast<std::ptrdiff_t>(degree), entry.column});
    }
    for (; row < rows; ++row)
        row_ends_[row] = terms_.data() + terms_.size();
    for (std::size_t i = 0; i < rows * columns; ++i)
        series_.push_back({numbers_.data() + i * size_, width_});
    operands_ = {terms_.data(), row_ends_.data(), numbers_.data(), rows, columns, size_};
}

void ColumnSeries::compute(std::span<const double> start, int highest) {
    require_size(start.size(), series_.size() * width_, "entries of a matrix");
    for (std::size_t i = 0; i < series_.size(); ++i)
        std::copy_n(&start[i * width_], width_, numbers_.data() + i * size_);
    table_.columns(operands_, highest);
}

void ColumnSeries::evaluate(std::span<const double> times, std::span<double> values, std::span<double> slopes) const {
    require_lanes(times);
    require_entries(values);
    require_entries(slopes);
    table_.sums_and_slopes(series_.data(), degrees_.data(), series_.size(), times.data(), values.data(), slopes.data());
}

void ColumnSeries::tails(std::span<const double> lengths, std::span<const double> scales,
                         std::span<double> worst) const {
    require_lanes(lengths);
    require_rows(scales);
    require_lanes(worst);
    require_room(static_cast<std::size_t>(order_), 2, "coefficients behind the first");
    table_.column_tails(operands_, order_, lengths.data(), scales.data(), worst.data());
}

void ColumnSeries::misfit(const ColumnSeries& end, const EndAllowance& allowance, std::span<const double> lengths,
                          std::span<const double> scales, std::span<const double> values,
                          std::span<const double> slopes, std::span<double> worst) const {
    require_size(end.series_.size(), series_.size(), "entries of a matrix");
    require_size(end.size_, size_, "coefficients of series");
    require_lanes(lengths);
    require_rows(scales);
    require_entries(values);
    require_entries(slopes);
    require_lanes(worst);
    table_.column_misfit(operands_,
                         {end.numbers_.data(), values.data(), slopes.data(), lengths.data(), scales.data(),
                          allowance.rates, allowance.smallest},
                         worst.data());
}

void ColumnSeries::require_lanes(std::span<const double> numbers) const {
    require_room(numbers.size(), width_, "numbers, one for each lane,");
}
void ColumnSeries::require_entries(std::span<const double> numbers) const {
    require_room(numbers.size(), series_.size() * width_, "entries of a matrix");
}
void ColumnSeries::require_rows(std::span<const double> numbers) const {
    require_room(numbers.size(), operands_.rows, "scales of rows");
}

} // namespace graze
