#pragma once

#include "graze/results/table_text.hpp"

#include <ostream>
#include <vector>

namespace graze {

enum class TableFormat { table, csv, json };

constexpr std::size_t gap = 2;         ///< between columns for people
constexpr std::size_t least_text = 30; ///< letters of a line that a text is broken to

/// How wide the columns are for people, headings included.
std::vector<std::size_t> column_widths(const Table& table, int digits);

/// @param digits significant digits; 17 tell any two numbers apart
/// @param heading what a JSON object says before columns, units and rows; other formats leave it out
/// @param longest letters in a line for people, 0: any; texts in the last column are broken to fit
void write_table(std::ostream& out, const Table& table, TableFormat format, int digits, const JsonObject& heading,
                 std::size_t longest = 0);

} // namespace graze
