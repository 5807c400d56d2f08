#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>

#include <complex>
#include <optional>

namespace graze {

// Linear equations with dense matrices, compiled in one place for the same reason as decompositions are. Eigen's
// classes of similar names do the work.

/// Factors of a square matrix that is known to be regular: rows are interchanged.
template <class Scalar>
class PartialLU {
public:
    using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    explicit PartialLU(const Matrix& matrix);
    Vector solve(const Vector& right) const;
    Matrix solve_columns(const Matrix& right) const;
    Vector solve_transposed(const Vector& right) const;
    Matrix inverse() const;

private:
    Eigen::PartialPivLU<Matrix> factors_;
};
extern template class PartialLU<double>;
extern template class PartialLU<std::complex<double>>;

/// Factors of a square matrix that may be singular: rows and columns are interchanged.
template <class Scalar>
class FullLU {
public:
    using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    FullLU() = default;
    explicit FullLU(const Matrix& matrix);
    void compute(const Matrix& matrix);
    Vector solve(const Vector& right) const;
    /// To working precision.
    bool is_invertible() const;
    Eigen::Index rank() const;
    Scalar determinant() const;
    /// About the reciprocal of the condition number.
    double reciprocal_condition() const;

private:
    Eigen::FullPivLU<Matrix> factors_;
};
extern template class FullLU<double>;
extern template class FullLU<std::complex<double>>;

/// Factors of a matrix of any shape by reflections, columns with most left first: for solutions by least squares.
class PivotedQR {
public:
    /// @param threshold of pivots that count, of the largest; none: by round-off
    explicit PivotedQR(const Eigen::MatrixXd& matrix, std::optional<double> threshold = {});
    Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
    Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& right) const;
    Eigen::Index rank() const;
    /// Entry of the triangle's diagonal.
    double pivot(Eigen::Index k) const;

private:
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors_;
};

/// Solution by least squares with a matrix that has at least as many rows as columns, and the triangle that it is
/// solved with, whose sums of squares are those of the matrix.
struct LeastSquares {
    Eigen::VectorXd solution;
    Eigen::MatrixXd triangle;
};
LeastSquares least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
/// The shortest of all solutions by least squares. @param threshold as for PivotedQR
Eigen::VectorXd shortest_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right,
                                  std::optional<double> threshold = {});
/// Puts such a triangle into the upper triangle of the matrix; what is below it means nothing then.
void make_triangular(Eigen::Ref<Eigen::MatrixXd> matrix);

double determinant(const Eigen::MatrixXd& matrix);

} // namespace graze
