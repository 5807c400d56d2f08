#pragma once

#include "graze/results/table.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// A table that fits a terminal.
struct FittedTable {
    Table table;
    std::vector<std::string> left_out; ///< names of columns that did not fit
    bool shortened = false;            ///< long signatures were shortened
};

/// A text of many words, shortened: repeated words are counted, as "impact (24 times)"; if that is still too long, the
/// beginning and the number of words are kept. @param most characters; at least 20
std::string shortened_words(const std::string& text, std::size_t most);

/// The columns of a table that fit the width in characters. Empty columns are left out first, then the least important
/// ones, then others from the right; the first column stays. Long signatures are shortened.
/// @param digits significant digits of its numbers
/// @param kept names of columns that are never left out
FittedTable fitted(const Table& table, int digits, std::size_t width, const std::vector<std::string>& kept);

} // namespace graze
