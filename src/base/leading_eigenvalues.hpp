#pragma once

#include <Eigen/Core>

#include <complex>
#include <optional>
#include <vector>

namespace graze {

/// A square matrix that is known by its products with vectors.
class LinearMap {
public:
    virtual ~LinearMap() = default;
    virtual Eigen::Index size() const = 0;
    virtual Eigen::VectorXd times(const Eigen::VectorXd& vector) const = 0;
    virtual Eigen::VectorXd transposed_times(const Eigen::VectorXd& vector) const = 0;
};

/// The eigenvalues of a large matrix that lie outside a circle.
struct LeadingEigenvalues {
    std::vector<std::complex<double>> values; ///< largest first
    double others_within = 0;                 ///< radius, below 1, of a circle around 0 that contains all others
};
/// Computes the eigenvalues near and outside the unit circle, and shows that there are no others, in a fraction of the
/// time that all of them take. A power of the matrix separates the wanted ones, which Arnoldi's method finds (W. E.
/// Arnoldi, Quart. Appl. Math. 9, 1951). What the matrix does outside their invariant subspace is a map to itself
/// again. The norm of a high power of this map, by Lanczos' method from a random vector, bounds its eigenvalues; the
/// chance that the norm is larger than is found is below 1e-9 (J. Kuczynski and H. Wozniakowski, "Estimating the
/// largest eigenvalue by the power and Lanczos algorithms with a random start", SIAM J. Matrix Anal. Appl. 13, 1992).
/// The random vectors are always the same.
/// @return none when too many eigenvalues are near the unit circle, or the matrix is small or not finite
std::optional<LeadingEigenvalues> leading_eigenvalues(const Eigen::MatrixXd& matrix);
/// The same for a matrix whose products with vectors take much less time than those of a full one. Low powers of it are
/// not computed, but applied factor by factor.
std::optional<LeadingEigenvalues> leading_eigenvalues(const LinearMap& map);

} // namespace graze
