#pragma once

#include <Eigen/Core>

#include <complex>

namespace graze {

/// A pair of multipliers on the unit circle: that with a positive imaginary part, and its vector.
struct TurningPair {
    std::complex<double> multiplier;
    Eigen::VectorXcd vector;
};

/// Returns the pair of the derivatives of a return that is nearest to the unit circle.
/// @throws InputError when none lies on it
TurningPair turning_pair(const Eigen::MatrixXd& derivatives);

} // namespace graze
