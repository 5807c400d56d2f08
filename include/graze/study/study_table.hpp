#pragma once

#include "graze/results/result_file.hpp"
#include "graze/results/table.hpp"
#include "graze/study/study.hpp"

namespace graze {

/// A table of a study, made from its results. A column of `ratios` has (x3 - x2)/(x2 - x1) of its column in the first
/// row, (x4 - x3)/(x3 - x2) in the second, and so on: what such distances go on with where they form a geometric
/// series. It is missing in the last two rows, and where a number is missing or two successive ones are the same.
/// @throws InputError when the table asks for something that the results do not have
Table make_table(const StudyTable& table, const ResultFile& file);

} // namespace graze
