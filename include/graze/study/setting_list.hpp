#pragma once

#include "graze/base/input_error.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// One of the settings of a run: a number or a text.
struct Setting {
    std::string name;             ///< path of the field, such as "vary.1.low": items of lists are numbered from 1 on
    std::optional<double> number; ///< none: the value is a text
    std::string text;             ///< also of a number, as it is written
};

/// Returns the settings of a run (RunRecord::settings, settings_of) one by one. A long list of numbers is replaced by
/// its length, its first and its last number: "vary.1.values.count", ".first", ".last".
/// @param place of the settings, for messages
/// @throws InputError when they are no JSON
std::vector<Setting> setting_list(const std::string& settings, const Place& place);

} // namespace graze
