#pragma once

#include <Eigen/Core>

#include <optional>

namespace graze {

// Decompositions of dense matrices, wrapped so that Eigen's templates are compiled once: each source that instantiates
// them would spend most of its compile time there. Eigen's classes of the same names do the work; the shapes are
// theirs. An empty real matrix has no singular values and no eigenvalues.

/// matrix = left * diagonal(values) * right.transpose(), by Jacobi's method; values in falling order.
struct SingularValues {
    Eigen::VectorXd values;
    Eigen::MatrixXd left, right; ///< filled as requested by SingularVectors

    /// Returns the number of values that are at least `threshold` times the largest one.
    Eigen::Index rank(double threshold) const;
};
enum class SingularVectors {
    none,
    right, ///< all right vectors, including those of the null space
    full,  ///< all left and right vectors
    thin   ///< min(rows, columns) vectors of either side
};
SingularValues singular_values(const Eigen::MatrixXd& matrix, SingularVectors vectors);
/// Returns the singular values of a complex matrix, in falling order.
Eigen::VectorXd singular_values(const Eigen::MatrixXcd& matrix);
/// Returns the right singular vector of the smallest singular value of a complex matrix.
Eigen::VectorXcd null_vector(const Eigen::MatrixXcd& matrix);

/// matrix * vectors = vectors * diagonal(values), in the order in which the method finds them.
struct Eigensystem {
    Eigen::VectorXcd values;
    Eigen::MatrixXcd vectors; ///< columns of norm 1
};
/// Both throw nothing. @return none when the iteration does not converge
std::optional<Eigensystem> eigensystem(const Eigen::MatrixXd& matrix);
std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& matrix);
/// Returns the eigenvalues of a symmetric matrix, in rising order.
std::optional<Eigen::VectorXd> symmetric_eigenvalues(const Eigen::MatrixXd& matrix);
/// The generalized eigenvalues mu, det(a - mu b) = 0, as numerators / denominators; mu is infinite where the
/// denominator is zero.
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

/// Returns the eigenvalues, or NaNs when the iteration does not converge.
Eigen::VectorXcd eigenvalues_or_nan(const Eigen::MatrixXd& matrix);

/// matrix = orthogonal * triangle, by Householder reflections.
struct OrthogonalFactors {
    Eigen::MatrixXd orthogonal; ///< rows x columns of the matrix
    Eigen::MatrixXd triangle;
};
OrthogonalFactors orthogonal_factors(const Eigen::MatrixXd& matrix);
/// Returns an orthonormal basis, in columns, of the orthogonal complement of a nonzero vector.
Eigen::MatrixXd orthogonal_complement(const Eigen::VectorXd& vector);
/// Returns orthogonal_complement(left).transpose() * matrix * orthogonal_complement(right), in time proportional to the
/// size of the matrix.
Eigen::MatrixXd between_complements(const Eigen::VectorXd& left, const Eigen::MatrixXd& matrix,
                                    const Eigen::VectorXd& right);

/// Approximate null vectors of a nearly rank-deficient matrix with one column more than rows, by QR with column
/// pivoting: matrix * right and left.transpose() * matrix are nearly zero.
struct NearlyNull {
    Eigen::MatrixXd right; ///< two orthonormal columns
    Eigen::VectorXd left;  ///< of norm 1
};
NearlyNull nearly_null(const Eigen::MatrixXd& matrix);

} // namespace graze
