#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Path of a program on the PATH; none if it is not there.
std::optional<std::string> find_program(std::string_view name);

struct ProcessResult {
    int status = 0;     ///< exit status; 128 plus the signal's number when killed
    std::string output; ///< standard output and standard error
};

/// Runs a program, without a shell, and waits for it.
/// @param arguments the first is the program's path
/// @param input text for its standard input
/// @throws std::system_error when it cannot be started
ProcessResult run_process(const std::vector<std::string>& arguments, std::string_view input);

} // namespace graze
