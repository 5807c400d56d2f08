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
    bool shortened = false;            ///< whether long signatures are not shown whole
};

/// A text of many words in fewer letters: words that follow each other many times are counted, as "impact (24 times)",
/// and what is longer still is told by its beginning and the number of its words. @param most letters; at least 20
std::string shortened_words(const std::string& text, std::size_t most);

/// A table with the columns that fit into lines of a width: those without any content go first, then those that people
/// look at last, then others from the right. The first column stays. Long signatures are shortened.
/// @param digits of its numbers
/// @param kept names of columns that stay in any case
FittedTable fitted(const Table& table, int digits, std::size_t width, const std::vector<std::string>& kept);

} // namespace graze
