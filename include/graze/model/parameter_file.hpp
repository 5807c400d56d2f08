#pragma once

#include "graze/base/input_error.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Values of parameters and initial states, as they were found for a model: what a user hands to further commands by
/// its name.
struct ParameterFile {
    using Values = std::vector<std::pair<std::string, double>>;
    std::string model{};                   ///< what it was found for; empty: anybody's
    std::string text{};                    ///< in words; may have several lines
    Values set{};                          ///< parameters
    Values from{};                         ///< initial states
    Values errors{};                       ///< standard errors of parameters; for people and programs, not used
    std::map<std::string, Place> places{}; ///< of "model", and of names such as "set.e" and "from.x", where it was read
};

/// TOML: `model`, `text`, and tables `set`, `from` and `errors` of numbers.
/// @throws InputError with file, line and column for anything else, and numbers that are not finite
ParameterFile parse_parameter_file(const std::string& text, const std::string& path);
ParameterFile read_parameter_file(const std::string& path);
/// Text that parse_parameter_file reads back, with digits that lose nothing.
std::string write_parameter_file(const ParameterFile& file);

} // namespace graze
