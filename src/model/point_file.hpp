#pragma once

#include "graze/symbolic/piece_table.hpp"

#include <string>
#include <vector>

namespace graze {

/// Reads two columns of a text file of numbers: one row a line, separated by commas, semicolons or white space; empty
/// lines and those that begin with # are skipped. The first row may name the columns.
/// @param columns two names; or none: the first two columns
/// @throws InputError with file, line and column
std::vector<PieceTable::Point> read_points(const std::string& path, const std::vector<std::string>& columns);

/// Returns the path of a file that a model names, relative to the model's folder.
/// @throws InputError if it is not in this folder or one inside it, also by a link
std::string path_inside(const std::string& folder, const std::string& file);

} // namespace graze
