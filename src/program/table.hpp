#pragma once

#include "graze/results/table_text.hpp"

#include <ostream>
#include <vector>

namespace graze {

enum class TableFormat { table, csv, json };

constexpr std::size_t gap = 2;         ///< blanks between columns in format `table`
constexpr std::size_t least_text = 30; ///< least width in characters of a column whose texts are broken into lines

/// Widths in characters of the columns in format `table`, headings included.
std::vector<std::size_t> column_widths(const Table& table, int digits);

/// @param digits significant digits; 17 distinguish any two numbers
/// @param heading members of the JSON object before columns, units and rows; other formats leave it out
/// @param longest characters in a line of format `table`, 0: no limit; texts in the last column are broken to fit
void write_table(std::ostream& out, const Table& table, TableFormat format, int digits, const JsonObject& heading,
                 std::size_t longest = 0);

} // namespace graze
