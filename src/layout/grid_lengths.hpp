#pragma once

#include "graze/layout/device_dimensions.hpp"

#include <cmath>
#include <cstdint>

namespace graze {

/// Converts to nanometres, rounded.
inline std::int64_t nanometres(double micrometres) {
    return std::llround(micrometres * grid_per_micrometre);
}

inline double micrometres(std::int64_t nanometres) {
    return static_cast<double>(nanometres) / grid_per_micrometre;
}

} // namespace graze
