#pragma once

#include "graze/results/stored_run.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace graze {

/// All that is stored of one point of a run. Of a branch: the orbit with its parameters, monitors, multipliers and what
/// certifies it; of a motion: its label, samples and facts; of records: samples, or estimates.
/// @throws InputError for an unknown run or point, and where the model of the run cannot be read
nlohmann::json point_json(const StoredRun& run, std::size_t number);
nlohmann::json point_json(const ResultFile& file, const std::string& run, std::size_t number);

} // namespace graze
