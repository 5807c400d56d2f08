#pragma once

#include "graze/base/input_error.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace graze {

/// Values of parameters and initial states found for a model by one command, to be passed to other commands as a file.
struct ParameterFile {
    using Values = std::vector<std::pair<std::string, double>>;
    std::string model{};                   ///< name of the model; empty: any model
    std::string text{};                    ///< description; may have several lines
    Values set{};                          ///< parameters
    Values from{};                         ///< initial states
    Values errors{};                       ///< standard errors of parameters; information only, not used
    std::map<std::string, Place> places{}; ///< where "model" and names such as "set.e" and "from.x" were read
};

/// Reads TOML: `model`, `text`, and the tables `set`, `from` and `errors` of numbers.
/// @throws InputError with file, line and column for other keys, and for numbers that are not finite
ParameterFile parse_parameter_file(const std::string& text, const std::string& path);
ParameterFile read_parameter_file(const std::string& path);
/// Returns a text that parse_parameter_file reads back without loss of digits.
std::string write_parameter_file(const ParameterFile& file);

} // namespace graze
