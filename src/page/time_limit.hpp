#pragma once

#include <functional>

namespace graze {

/// A function for computations that ask whether to stop: true from so many seconds after now on, or when another one
/// says so. @param interrupted may be empty
std::function<bool()> time_limit(double seconds, const std::function<bool()>& interrupted = {});

} // namespace graze
