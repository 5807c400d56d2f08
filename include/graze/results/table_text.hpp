#pragma once

#include "graze/results/json_object.hpp"
#include "graze/results/table.hpp"

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

namespace graze {

/// @param digits significant digits; 17 tell any two numbers apart
std::string cell_text(const Table& table, std::size_t row, std::size_t column, int digits);

/// As CSV with a line of names. @param digits as above
void write_csv(std::ostream& out, const Table& table, int digits);
/// The same as text with all digits.
std::string csv_text(const Table& table);

/// As one JSON object: a heading, then columns, units and rows. What is not finite is null.
void write_json(std::ostream& out, const Table& table, int digits, const JsonObject& heading);
/// The rows as objects with the columns' names; a number that is missing is left out.
std::vector<JsonObject> json_rows(const Table& table);

} // namespace graze
