#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Converts an index to Eigen's signed type.
inline Eigen::Index index(std::size_t i) {
    return static_cast<Eigen::Index>(i);
}

/// View numbers as a vector, for reading or for writing.
inline Eigen::Map<const Eigen::VectorXd> vector_of(std::span<const double> values) {
    return {values.data(), index(values.size())};
}
inline Eigen::Map<Eigen::VectorXd> entries_of(std::span<double> values) {
    return {values.data(), index(values.size())};
}
inline std::vector<double> numbers_of(const Eigen::VectorXd& vector) {
    return {vector.begin(), vector.end()};
}

} // namespace graze
