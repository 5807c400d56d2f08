#pragma once

#include "graze/results/result_file.hpp"

#include <string>

namespace graze {

/// Copies the points, orbits and estimates of a run to one that has been begun in another file.
/// @param name of that one
void copy_rows(const ResultFile& from, const RunRecord& run, ResultFile& to, const std::string& name);

/// Copies a run with all its results into another file, in place of one with the same name.
/// @param copy describes the run there
void copy_run(const ResultFile& from, const RunRecord& run, ResultFile& to, const RunRecord& copy);

} // namespace graze
