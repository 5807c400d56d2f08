#pragma once

#include "graze/base/input_error.hpp"
#include "graze/layout/etched_wall.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

namespace graze {

/// Formats a value for messages; a length in m is given in um.
inline std::string size_text(double value, std::string_view unit) {
    constexpr double micro = 1e-6;
    return unit == "m" ? fmt::format("{:.6g} um", value / micro) : fmt::format("{:.6g} {}", value, unit);
}

/// @throws InputError unless it is positive and finite
inline void require_positive(double value, std::string_view what, std::string_view unit = "m") {
    if (!(value > 0 && std::isfinite(value)))
        throw InputError(fmt::format("the {} is {}", what, size_text(value, unit)), "it must be positive and finite");
}

/// @throws InputError unless it is positive and finite at all depths
inline void require_positive(const EtchedWidth& width, std::string_view what) {
    require_positive(width.least(), what);
    require_positive(width.greatest(), what);
}

/// @throws InputError unless it is finite and not negative
inline void require_not_negative(double value, std::string_view what, std::string_view unit = "m") {
    if (!(value >= 0 && std::isfinite(value)))
        throw InputError(fmt::format("the {} is {}", what, size_text(value, unit)),
                         "it must be finite and not negative");
}

} // namespace graze
