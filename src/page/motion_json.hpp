#pragma once

#include "graze/results/stored_run.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace graze {

/// The motion of a stored point, as motion_rows_json gives it: of a branch along its orbit, of other runs computed
/// again from where it began; of records the rows themselves.
/// @param names states, values or expressions; none: the states, or channels, that pictures show
/// @param interrupted asked now and then; true ends the motion, which is not complete then; so do 10 s of computing
/// @throws InputError for an unknown run, point or name, and where the file does not say how the motion began
nlohmann::json motion_json(const StoredRun& run, std::size_t number, const std::vector<std::string>& names,
                           const std::function<bool()>& interrupted = {});
nlohmann::json motion_json(const ResultFile& file, const std::string& run, std::size_t number,
                           const std::vector<std::string>& names, const std::function<bool()>& interrupted = {});

} // namespace graze
