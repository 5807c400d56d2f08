#pragma once

#include "graze/results/result_file.hpp"
#include "graze/study/study.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// What results keep of a run besides its points.
/// @param parent_fingerprint of the runs that it needs
/// @param points planned
RunRecord record_of(const StudyRun& run, const std::string& parent_fingerprint, std::size_t points);

/// Ways in which a run of kind continue, or a sweep, goes.
std::vector<std::string> direction_names(const StudyRun& run);

/// A run as it was asked for, without its model, as texts.
struct AskedRun {
    std::string name, kind, settings, version;
    std::string file = {};               ///< from which these texts come, for messages
    std::vector<std::string> units = {}; ///< of its values; of branches, of its monitors
};

/// Makes the run. @throws InputError when the settings cannot be read, or come from another version that has more of
/// them
StudyRun run_of(const AskedRun& asked, Model model);

} // namespace graze
