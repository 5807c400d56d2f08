#pragma once

#include "graze/results/orbit_record.hpp"
#include "graze/results/result_file.hpp"

#include <nlohmann/json.hpp>

namespace graze {

/// What a point of a branch is: number, label, name, type and its words, detail, part, whether stable and unphysical.
nlohmann::json orbit_facts(const RunRecord& run, const OrbitRecord& record);

} // namespace graze
