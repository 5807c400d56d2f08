#pragma once

#include "graze/symbolic/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace graze {

/// @throws InputError unless it is positive and finite
inline void require_positive(double value, std::string_view what) {
    if (!(value > 0 && std::isfinite(value)))
        throw InputError(fmt::format("the {} is {}", what, value), "it must be positive and finite");
}

/// @throws InputError unless it is finite and not negative
inline void require_not_negative(double value, std::string_view what) {
    if (!(value >= 0 && std::isfinite(value)))
        throw InputError(fmt::format("the {} is {}", what, value), "it must be finite and not negative");
}

/// @throws InputError for NaN and infinities
inline void require_number(double value, std::string_view what) {
    if (!std::isfinite(value))
        throw InputError(fmt::format("the {} is {}", what, value), "it must be finite");
}

} // namespace graze
