#include "tape/column_series.hpp"

#include "graze/symbolic/require.hpp"

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
    require_room(times.size(), width_, "times");
    require_room(values.size(), series_.size() * width_, "entries of a matrix");
    require_room(slopes.size(), series_.size() * width_, "slopes of a matrix");
    table_.sums_and_slopes(series_.data(), degrees_.data(), series_.size(), times.data(), values.data(), slopes.data());
}

} // namespace graze
