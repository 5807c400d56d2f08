#include "graze/results/table.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>

#include <cmath>

namespace graze {

void Table::add(double value) {
    cells_.push_back({value, none});
}

void Table::add(std::string_view text) {
    auto found = text_indices_.find(text);
    if (found == text_indices_.end()) {
        found = text_indices_.emplace(std::string(text), static_cast<std::uint32_t>(texts_.size())).first;
        texts_.push_back(found->first);
    }
    cells_.push_back({0, found->second});
}

void Table::add_extended(double value) {
    if (std::isinf(value))
        add(value > 0 ? "inf" : "-inf");
    else
        add(value);
}

const Table::Cell& Table::cell(std::size_t row, std::size_t column) const {
    require_index(column, columns_.size(), "column");
    require_index(row, rows(), "row");
    return cells_[row * columns_.size() + column];
}

const std::string& Table::text(std::size_t row, std::size_t column) const {
    const std::uint32_t index = cell(row, column).text;
    if (index == none)
        throw InputError(fmt::format("the cell in row {} of column '{}' is a number", row, columns_[column].name),
                         "ask for its number");
    return texts_[index];
}

bool Table::is_missing(std::size_t row, std::size_t column) const {
    return !is_text(row, column) && !std::isfinite(number(row, column));
}

std::vector<std::string> Table::incomplete_columns() const {
    std::vector<std::string> names;
    for (std::size_t column = 0; column < columns_.size(); ++column)
        for (std::size_t row = 0; row < rows(); ++row)
            if (is_missing(row, column)) {
                names.push_back(columns_[column].name);
                break;
            }
    return names;
}

void Table::drop_odd_rows() {
    const std::size_t width = columns_.size();
    std::size_t kept = 0;
    for (std::size_t row = 0; row < rows(); row += 2, ++kept)
        for (std::size_t column = 0; column < width; ++column)
            cells_[kept * width + column] = cells_[row * width + column];
    cells_.resize(kept * width);
}

} // namespace graze
