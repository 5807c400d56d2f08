#pragma once

#include "graze/results/stored_run.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace graze {

/// The special points of a branch: its columns (parameters, then monitors) and a row for each point. Other runs have no
/// rows. @throws InputError for an unknown run
nlohmann::json special_points_json(const StoredRun& run);
nlohmann::json special_points_json(const ResultFile& file, const std::string& run);

} // namespace graze
