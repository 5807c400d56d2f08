#pragma once

#include "results/columns.hpp"

namespace graze {

struct NoContext {};

/// Of the table of runs, behind their number.
const ColumnsOf<NoContext, RunRecord>& run_columns();

/// A run's lists of names and columns lie in tables of their own.
void write_lists(const Database& database, const RunRecord& run);
void read_lists(const Database& database, RunRecord& run);

} // namespace graze
