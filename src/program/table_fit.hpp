#pragma once

#include "graze/results/table.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// What of a table is shown to people.
struct FittedTable {
    Table table;
    std::vector<std::string> left_out; ///< names of columns for which there was no room
};

/// A table with the columns that fit into lines of a width: those without any content go first, then those that people
/// look at last, then others from the right. The first column stays.
/// @param digits of its numbers
/// @param kept names of columns that stay in any case
FittedTable fitted(const Table& table, int digits, std::size_t width, const std::vector<std::string>& kept);

} // namespace graze
