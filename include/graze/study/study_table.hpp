#pragma once

#include "graze/results/result_file.hpp"
#include "graze/results/table.hpp"
#include "graze/study/study.hpp"

namespace graze {

/// Makes a table of a study from its results. A column of `ratios` has (x3 - x2)/(x2 - x1) of its column in the first
/// row, (x4 - x3)/(x3 - x2) in the second, and so on: the ratio of the geometric series that the distances may form.
/// Its cells are empty in the last two rows, and where a number is missing or two successive numbers are equal.
/// @throws InputError when the table asks for something that the results do not have
Table make_table(const StudyTable& table, const ResultFile& file);

} // namespace graze
