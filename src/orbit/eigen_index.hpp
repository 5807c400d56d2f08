#pragma once

#include "base/many_states.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Converts an index to Eigen's signed type.
inline Eigen::Index index(std::size_t i) {
    return static_cast<Eigen::Index>(i);
}

/// Matrices in the order of plain arrays, row by row.
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// View numbers as a vector, for reading or for writing.
inline Eigen::Map<const Eigen::VectorXd> vector_of(std::span<const double> values) {
    return {values.data(), index(values.size())};
}
inline Eigen::Map<Eigen::VectorXd> entries_of(std::span<double> values) {
    return {values.data(), index(values.size())};
}
/// View the numbers of such a matrix.
inline std::span<double> numbers_of(RowMajor& matrix) {
    return {matrix.data(), static_cast<std::size_t>(matrix.size())};
}
inline std::vector<double> numbers_of(const Eigen::VectorXd& vector) {
    return {vector.begin(), vector.end()};
}

} // namespace graze
