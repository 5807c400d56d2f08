#pragma once

#include <Eigen/Core>

#include <complex>
#include <optional>

namespace graze {

// Decompositions of dense matrices, compiled in one place: what Eigen makes of its templates in each source that uses
// them takes longer to compile than all else in it. Sizes are those of Eigen's classes of the same names, which
// do the work. Where a matrix of real numbers is empty, its singular values and its eigenvalues are none.

/// matrix = left * diagonal(values) * right.transpose(), by Jacobi's method; values fall.
struct SingularValues {
    Eigen::VectorXd values;
    Eigen::MatrixXd left, right; ///< as asked for

    /// How many values are at least `threshold` times the largest.
    Eigen::Index rank(double threshold) const;
};
enum class SingularVectors {
    none,
    right, ///< all right ones: with them those that the matrix takes to zero
    full,  ///< all of both sides
    thin   ///< as many of both sides as the shorter side of the matrix is long
};
SingularValues singular_values(const Eigen::MatrixXd& matrix, SingularVectors vectors);
/// The same values of a complex matrix.
Eigen::VectorXd singular_values(const Eigen::MatrixXcd& matrix);
/// The right singular vector of the least singular value of a complex matrix.
Eigen::VectorXcd null_vector(const Eigen::MatrixXcd& matrix);

/// matrix * vectors = vectors * diagonal(values), in the order in which the method finds them.
struct Eigensystem {
    Eigen::VectorXcd values;
    Eigen::MatrixXcd vectors; ///< columns of length 1
};
/// Both throw nothing. @return none where the method does not converge
std::optional<Eigensystem> eigensystem(const Eigen::MatrixXd& matrix);
std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& matrix);
/// Of a symmetric matrix, in rising order.
std::optional<Eigen::VectorXd> symmetric_eigenvalues(const Eigen::MatrixXd& matrix);
/// Numbers mu with det(a - mu b) = 0, as numerators and denominators: mu is infinite where the latter is zero.
struct GeneralizedEigenvalues {
    Eigen::VectorXcd numerators;
    Eigen::VectorXd denominators;
};
std::optional<GeneralizedEigenvalues> generalized_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// matrix = unitary * triangle * unitary.adjoint(), with the eigenvalues along the diagonal of the triangle.
struct SchurForm {
    Eigen::MatrixXcd unitary, triangle;
};
std::optional<SchurForm> schur_form(const Eigen::MatrixXd& matrix);

/// The same; where the method does not converge, numbers that are not any.
Eigen::VectorXcd eigenvalues_or_nan(const Eigen::MatrixXd& matrix);

/// matrix = orthogonal * triangle, by Householder's reflections.
struct OrthogonalFactors {
    Eigen::MatrixXd orthogonal; ///< with as many columns as the matrix
    Eigen::MatrixXd triangle;
};
OrthogonalFactors orthogonal_factors(const Eigen::MatrixXd& matrix);
/// Orthonormal basis of what is orthogonal to a vector that is not zero, in columns.
Eigen::MatrixXd orthogonal_complement(const Eigen::VectorXd& vector);

/// What a matrix with one column more than it has rows, and nearly a rank less than it has rows, takes to nearly
/// nothing from either side, by pivoted reflections.
struct NearlyNull {
    Eigen::MatrixXd right; ///< two orthonormal columns
    Eigen::VectorXd left;  ///< of length 1
};
NearlyNull nearly_null(const Eigen::MatrixXd& matrix);

} // namespace graze
