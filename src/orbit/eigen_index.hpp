#pragma once

#include <Eigen/Core>

#include <cstddef>

namespace graze {

/// Converts an index to Eigen's signed type.
inline Eigen::Index index(std::size_t i) {
    return static_cast<Eigen::Index>(i);
}

} // namespace graze
