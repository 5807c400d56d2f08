#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace graze {

/// A table with named columns of numbers and texts, to be shown or written. Functions that take a row and a column
/// throw InputError if there is no such cell.
class Table {
public:
    struct Column {
        std::string name, unit;
    };

    Table() = default;
    explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}
    explicit Table(std::initializer_list<Column> columns) : columns_(columns) {}

    /// Adds one cell; cells are added row by row. A number that is not finite counts as missing.
    void add(double value);
    void add(std::string_view text);
    /// Adds several cells in this order: numbers, of which optional ones count as missing where they are empty, and
    /// texts.
    template <class First, class Second, class... Others>
    void add(const First& first, const Second& second, const Others&... others) {
        add_any(first);
        add_any(second);
        (add_any(others), ...);
    }
    /// Adds a number; an infinite one becomes the text "inf" or "-inf".
    void add_extended(double value);

    const std::vector<Column>& columns() const { return columns_; }
    std::size_t rows() const { return columns_.empty() ? 0 : cells_.size() / columns_.size(); }
    bool is_text(std::size_t row, std::size_t column) const { return cell(row, column).text != none; }
    /// Whether a number is missing.
    bool is_missing(std::size_t row, std::size_t column) const;
    double number(std::size_t row, std::size_t column) const { return cell(row, column).number; }
    /// @throws InputError if the cell has a number
    const std::string& text(std::size_t row, std::size_t column) const;
    /// Names of the columns in which a number is missing.
    std::vector<std::string> incomplete_columns() const;
    /// Keeps only the rows 0, 2, 4, ...
    void drop_odd_rows();

private:
    static constexpr std::uint32_t none = 0xffffffff;
    struct Cell {
        double number;
        std::uint32_t text; ///< index of a text, or `none`
    };
    const Cell& cell(std::size_t row, std::size_t column) const;
    template <class Value>
    void add_any(const Value& value) {
        if constexpr (std::is_arithmetic_v<Value>)
            add(static_cast<double>(value));
        else if constexpr (std::is_same_v<Value, std::optional<double>>)
            add(value.value_or(std::numeric_limits<double>::quiet_NaN()));
        else
            add(std::string_view(value));
    }

    std::vector<Column> columns_;
    std::vector<Cell> cells_;
    std::map<std::string, std::uint32_t, std::less<>> text_indices_; ///< equal texts are stored only once
    std::vector<std::string> texts_;
};

} // namespace graze
