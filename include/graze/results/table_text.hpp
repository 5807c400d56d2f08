#pragma once

#include "graze/results/json_object.hpp"
#include "graze/results/table.hpp"

#include <cstddef>
#include <ostream>
#include <string>
#include <vector>

namespace graze {

/// Text of a cell; empty if a number is missing. @param digits significant digits; 17 represent every number exactly
std::string cell_text(const Table& table, std::size_t row, std::size_t column, int digits);

/// Writes a table as CSV, with a first line of column names. @param digits see cell_text
void write_csv(std::ostream& out, const Table& table, int digits);
/// A table as CSV with 17 digits.
std::string csv_text(const Table& table);

/// Writes a table as one JSON object: members of a heading, then columns, units and rows. Missing numbers are null.
void write_json(std::ostream& out, const Table& table, int digits, const JsonObject& heading);
/// Adds a cell to an object; a missing number is null.
void add_cell(JsonObject& object, const std::string& name, const Table& table, std::size_t row, std::size_t column);
/// What becomes of missing numbers.
enum class MissingCells { left_out, null };
/// The rows as objects whose members are named as the columns.
std::vector<JsonObject> json_rows(const Table& table, MissingCells missing = MissingCells::left_out);

} // namespace graze
