#pragma once

#include "graze/acquire/instrument_line.hpp"

#include <fmt/format.h>

#include <utility>

namespace graze {

/// Throws an InstrumentError with a formatted problem.
template <class... Parts>
[[noreturn]] void fail(AcquisitionEnding ending, fmt::format_string<Parts...> problem, Parts&&... parts) {
    throw InstrumentError(ending, fmt::format(problem, std::forward<Parts>(parts)...));
}

} // namespace graze
