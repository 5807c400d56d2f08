#pragma once

#include "results/columns.hpp"

namespace graze {

struct NoContext {};

/// Of the table of runs, behind their number.
const ColumnsOf<NoContext, RunRecord>& run_columns();

/// Under which key of the table `meta` it is told why a run failed: this, and its name.
inline constexpr const char* begin_of_failure = "failure of run ";
std::string key_of_failure(const std::string& run);

/// A run's lists of names and columns lie in tables of their own.
void write_lists(const Database& database, const RunRecord& run);
void read_lists(const Database& database, RunRecord& run);
/// Names of points, in the place of those that there are.
void write_point_names(const Database& database, const std::string& run, const std::vector<PointName>& names);
/// What says in the table of names that one is that of the point with a label: this, and the label.
inline constexpr const char* begin_of_point_name = "point ";

} // namespace graze
