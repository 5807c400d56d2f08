#pragma once

#include "graze/results/orbit_record.hpp"
#include "graze/results/stored_run.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

// Points of a run by their numbers. @throws InputError if the run has none of this number

/// Of a branch.
OrbitRecord orbit_numbered(const StoredRun& run, std::size_t number);
/// Of other runs, with its samples.
PointRecord point_numbered(const StoredRun& run, std::size_t number);

/// The model at the parameters of a point of a run without orbits.
Model model_of_point(const StoredRun& run, const PointRecord& point);

/// The name at an index; empty beyond the last, which is how a direction or sampling that the run does not have is
/// read.
std::string name_at(const std::vector<std::string>& names, std::size_t index);

/// Whether the points of a run are records or what was found from them.
bool is_measured_run(const RunRecord& run);

} // namespace graze
