#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>

#include <complex>
#include <optional>

namespace graze {

// Linear systems with dense matrices, compiled once for the same reason as decompositions. Eigen's classes of similar
// names do the work.

/// LU factors, with row pivoting, of a square matrix that is known to be regular.
class PartialLU {
public:
    explicit PartialLU(const Eigen::MatrixXd& matrix);
    Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
    Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& right) const;
    Eigen::VectorXd solve_transposed(const Eigen::VectorXd& right) const;
    Eigen::MatrixXd inverse() const;
    double determinant() const;
    /// True when the matrix, which may then have been singular, is regular to working precision.
    bool is_regular() const;
    double reciprocal_condition() const; ///< an estimate

private:
    Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
};

/// LU factors, with row pivoting, of a complex square matrix that is known to be regular.
class ComplexLU {
public:
    explicit ComplexLU(const Eigen::MatrixXcd& matrix);
    Eigen::VectorXcd solve(const Eigen::VectorXcd& right) const;
    Eigen::VectorXcd solve_transposed(const Eigen::VectorXcd& right) const;

private:
    Eigen::PartialPivLU<Eigen::MatrixXcd> factors_;
};

/// LU factors, with full pivoting, of a square matrix that may be singular.
template <class Scalar>
class FullLU {
public:
    using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    FullLU() = default;
    explicit FullLU(const Matrix& matrix);
    void compute(const Matrix& matrix);
    Vector solve(const Vector& right) const;
    /// True when the matrix is regular to working precision.
    bool is_invertible() const;
    Eigen::Index rank() const;
    Scalar determinant() const;
    /// Returns an estimate of the reciprocal of the condition number.
    double reciprocal_condition() const;

private:
    Eigen::FullPivLU<Matrix> factors_;
};
extern template class FullLU<double>;
extern template class FullLU<std::complex<double>>;

/// LU factors of a square matrix that is expected to be regular: with full pivoting, or, where it is so large that this
/// takes many times as long, with partial pivoting.
class CheckedLU {
public:
    CheckedLU() = default;
    explicit CheckedLU(const Eigen::MatrixXd& matrix) { compute(matrix); }
    void compute(const Eigen::MatrixXd& matrix);
    Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
    /// True when the matrix is regular to working precision.
    bool is_invertible() const;
    double determinant() const;

private:
    FullLU<double> full_;
    std::optional<PartialLU> partial_; ///< in its place
};

/// QR factors, with column pivoting, of a matrix of any shape: for least squares.
class PivotedQR {
public:
    /// @param threshold relative size of a pivot that counts for the rank; none: Eigen's default, by round-off
    explicit PivotedQR(const Eigen::MatrixXd& matrix, std::optional<double> threshold = {});
    Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
    Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& right) const;
    Eigen::Index rank() const;
    /// Returns the k-th diagonal entry of the triangular factor.
    double pivot(Eigen::Index k) const;

private:
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors_;
};

/// The least-squares solution with a matrix that has at least as many rows as columns, and the upper triangular factor
/// R of the matrix A, for which R^T R = A^T A.
struct LeastSquares {
    Eigen::VectorXd solution;
    Eigen::MatrixXd triangle;
};
LeastSquares least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// Returns the least-squares solution of least norm. @param threshold as for PivotedQR
Eigen::VectorXd shortest_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right,
                                  std::optional<double> threshold = {});
/// Replaces the upper triangle of the matrix by its factor R; the entries below are then meaningless.
void make_triangular(Eigen::MatrixXd& matrix);
/// Makes the matrix, with more rows than columns, upper triangular by Householder reflections x - m (m^T x), |m|^2 = 2,
/// and applies them to other columns. @return the vectors m, zero where no reflection was needed
Eigen::MatrixXd make_triangular_with(Eigen::MatrixXd& matrix, Eigen::MatrixXd& others);

double determinant(const Eigen::MatrixXd& matrix);

} // namespace graze
