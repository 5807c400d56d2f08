#pragma once

#include "graze/study/study.hpp"

#include <string>
#include <vector>

namespace graze {

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
