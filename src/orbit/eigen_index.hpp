#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace graze {

/// Converts an index to Eigen's signed type.
inline Eigen::Index index(std::size_t i) {
    return static_cast<Eigen::Index>(i);
}

/// Matrices in the order of plain arrays, row by row.
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Returns the numbers of such a matrix.
inline std::span<double> numbers_of(RowMajor& matrix) {
    return {matrix.data(), static_cast<std::size_t>(matrix.size())};
}

} // namespace graze
