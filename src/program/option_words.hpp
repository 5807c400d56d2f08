#pragma once

#include <span>
#include <string>

namespace graze {

/// A message of the library, which knows nothing of command lines, with the options that do what it advises.
/// @param arguments of the command line: a place in the message that one of them names may be a file
std::string in_options(const std::string& message, std::span<const std::string> arguments = {});

} // namespace graze
