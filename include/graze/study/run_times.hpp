#pragma once

#include "graze/results/result_file.hpp"

#include <ctime>
#include <optional>
#include <string>

namespace graze {

/// When a run was made. Numbers do not depend on it.
struct RunTimes {
    std::string begun, ended; ///< as in "2026-11-22T09:31:36Z"; `ended` is empty while it goes on, and after a kill
    double seconds = 0;       ///< of work, of all attempts that went on with one another
};

/// A moment as RunTimes has it; the present one.
std::string text_of(std::time_t moment);
std::string present_time();
/// Keeps them in a result file.
void note_times(ResultFile& file, const std::string& run, const RunTimes& times);
/// None in files of versions that did not keep them. @throws InputError when they cannot be read
std::optional<RunTimes> times_of(const ResultFile& file, const std::string& run);

} // namespace graze
