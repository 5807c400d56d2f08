#pragma once

#include "results/columns.hpp"

namespace graze {

struct NoContext {};

/// Columns of the table of runs, after the number.
const ColumnsOf<NoContext, RunRecord>& run_columns();

/// The table `meta` stores why a run failed, under a key with this prefix and the name of the run.
inline constexpr const char* begin_of_failure = "failure of run ";
std::string key_of_failure(const std::string& run);

/// Write and read the lists of names and columns of a run, which are stored in separate tables.
void write_lists(const Database& database, const RunRecord& run);
void read_lists(const Database& database, RunRecord& run);
/// Writes names of points in place of the earlier ones.
void write_point_names(const Database& database, const std::string& run, const std::vector<PointName>& names);
/// The table of names stores the name of a point under this prefix and the label of the point.
inline constexpr const char* begin_of_point_name = "point ";

} // namespace graze
