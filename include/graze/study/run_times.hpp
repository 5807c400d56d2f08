#pragma once

#include "graze/results/result_file.hpp"

#include <ctime>
#include <optional>
#include <string>

namespace graze {

/// When a run was computed. Results do not depend on it.
struct RunTimes {
    std::string begun,
        ended;          ///< such as "2026-11-22T09:31:36Z"; `ended` is empty while the run goes on, and after a kill
    double seconds = 0; ///< of computing, the sum over all attempts that continued one another
};

/// The text of a moment in the form of RunTimes; that of the present moment.
std::string text_of(std::time_t moment);
std::string present_time();
/// Stores the times of a run in a result file.
void note_times(ResultFile& file, const std::string& run, const RunTimes& times);
/// Returns the stored times of a run; none in files of versions that did not store them. @throws InputError when they
/// cannot be read
std::optional<RunTimes> times_of(const ResultFile& file, const std::string& run);

} // namespace graze
