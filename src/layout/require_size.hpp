#pragma once

#include "graze/symbolic/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace graze {

/// @throws InputError unless it is positive and finite
inline void require_positive(double value, std::string_view what, std::string_view unit = "m") {
    if (!(value > 0 && std::isfinite(value)))
        throw InputError(fmt::format("the {} is {:.6g} {}", what, value, unit), "it must be positive and finite");
}

/// @throws InputError unless it is finite and not negative
inline void require_not_negative(double value, std::string_view what, std::string_view unit = "m") {
    if (!(value >= 0 && std::isfinite(value)))
        throw InputError(fmt::format("the {} is {:.6g} {}", what, value, unit), "it must be finite and not negative");
}

} // namespace graze
