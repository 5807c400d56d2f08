#pragma once

#include "graze/results/result_file.hpp"
#include "graze/results/table.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace graze {

/// A table: its title, columns with names and units, and rows of numbers and texts. Missing numbers are null.
nlohmann::json table_json(const std::string& title, const Table& table);
/// The same of rows of a query. Of more rows than `most` the first ones, and `left_out` is true.
nlohmann::json table_json(const std::string& title, ResultFile::Rows rows, const std::vector<std::string>& units,
                          std::size_t most = std::numeric_limits<std::size_t>::max());

} // namespace graze
