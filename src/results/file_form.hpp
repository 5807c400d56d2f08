#pragma once

#include "graze/results/result_file.hpp"
#include "results/database.hpp"

#include <string>
#include <vector>

namespace graze {

/// Under which key of the table `meta` it is told which format a reader has to know at least.
inline constexpr const char* oldest_reader_key = "oldest reader";

/// Lets the tables of a file of another format be asked as those of this one: what they call otherwise is found under
/// its name, and what they do not have is missing. The file stays as it is.
/// @return what is missing, as "run.column" or the name of a table
std::vector<std::string> show_in_this_form(const Database& database, const std::vector<RunRecord>& runs);

/// Gives the tables of an older file the names and columns that this format has, for it to be gone on with: in a
/// transaction. @return the same
std::vector<std::string> bring_into_this_form(const Database& database, const std::vector<RunRecord>& runs);

} // namespace graze
