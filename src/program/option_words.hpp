#pragma once

#include <string>

namespace graze {

/// A message of the library, which knows nothing of command lines, with the options that do what it advises.
std::string in_options(const std::string& message);

} // namespace graze
