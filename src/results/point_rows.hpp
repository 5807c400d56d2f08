#pragma once

#include "graze/results/result_file.hpp"
#include "results/database.hpp"

namespace graze {

/// Writes a point, without its samples, as a row of its run's table.
void write_point(Statement& statement, const RunRecord& run, const PointRecord& point);
/// Reads one such row.
PointRecord read_point(const Statement& row, const RunRecord& run);
std::size_t index_of(const std::vector<std::string>& names, const std::string& name);

} // namespace graze
