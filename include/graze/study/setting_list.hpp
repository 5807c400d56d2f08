#pragma once

#include "graze/base/input_error.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// One of the settings of a run: a number or a text.
struct Setting {
    std::string name; ///< as in "vary.1.low": of members of lists their number
    std::optional<double> number;
    std::string text; ///< of a number as it is written
};

/// The settings of a run (RunRecord::settings, settings_of), one by one. Of long lists of numbers only how many there
/// are, the first and the last: "vary.1.values.count", ".first", ".last".
/// @param place of the settings, for messages
/// @throws InputError when they are no JSON
std::vector<Setting> setting_list(const std::string& settings, const Place& place);

} // namespace graze
