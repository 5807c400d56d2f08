#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Full path of a program on the PATH.
std::optional<std::string> find_program(std::string_view name);

struct ProcessResult {
    int status = 0;     ///< exit status; 128 and the signal when killed
    std::string output; ///< of both streams
};

/// Runs a program, no shell being involved, and waits for it.
/// @param arguments the first is the program's path
/// @param input its standard input
/// @throws std::system_error when it cannot be started
ProcessResult run_process(const std::vector<std::string>& arguments, std::string_view input);

} // namespace graze
