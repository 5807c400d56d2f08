#pragma once

#include "graze/study/study.hpp"

#include <string>
#include <vector>

namespace graze {

/// A run as it was asked for, in words: all of it but the model.
struct AskedRun {
    std::string name, kind, settings, version;
    std::string file = {};               ///< that says so
    std::vector<std::string> units = {}; ///< of its values, or monitors
};

/// The run of these words. @throws InputError when the settings cannot be read, or are of another version with more of
/// them
StudyRun run_of(const AskedRun& asked, Model model);

} // namespace graze
