#include "base/linear_systems.hpp"

#include "base/decompositions.hpp"
#include "base/many_states.hpp"
#include "base/special_numbers.hpp"

namespace graze {

PartialLU::PartialLU(const Eigen::MatrixXd& matrix) : factors_(matrix) {}

Eigen::VectorXd PartialLU::solve(const Eigen::VectorXd& right) const {
    return factors_.solve(right);
}

Eigen::MatrixXd PartialLU::solve_columns(const Eigen::MatrixXd& right) const {
    return factors_.solve(right);
}

Eigen::VectorXd PartialLU::solve_transposed(const Eigen::VectorXd& right) const {
    return factors_.transpose().solve(right);
}

Eigen::MatrixXd PartialLU::inverse() const {
    return factors_.inverse();
}

double PartialLU::determinant() const {
    return factors_.determinant();
}

bool PartialLU::is_regular() const {
    return reciprocal_condition() > epsilon;
}

double PartialLU::reciprocal_condition() const {
    return factors_.rcond();
}

ComplexLU::ComplexLU(const Eigen::MatrixXcd& matrix) : factors_(matrix) {}

Eigen::VectorXcd ComplexLU::solve(const Eigen::VectorXcd& right) const {
    return factors_.solve(right);
}

Eigen::VectorXcd ComplexLU::solve_transposed(const Eigen::VectorXcd& right) const {
    return factors_.transpose().solve(right);
}

template <class Scalar>
FullLU<Scalar>::FullLU(const Matrix& matrix) : factors_(matrix) {}

template <class Scalar>
void FullLU<Scalar>::compute(const Matrix& matrix) {
    factors_.compute(matrix);
}

template <class Scalar>
auto FullLU<Scalar>::solve(const Vector& right) const -> Vector {
    return factors_.solve(right);
}

template <class Scalar>
bool FullLU<Scalar>::is_invertible() const {
    return factors_.isInvertible();
}

template <class Scalar>
Eigen::Index FullLU<Scalar>::rank() const {
    return factors_.rank();
}

template <class Scalar>
Scalar FullLU<Scalar>::determinant() const {
    return factors_.determinant();
}

template <class Scalar>
double FullLU<Scalar>::reciprocal_condition() const {
    return factors_.rcond();
}

template class FullLU<double>;
// All that is asked of complex ones.
template FullLU<std::complex<double>>::FullLU(const Matrix&);
template auto FullLU<std::complex<double>>::solve(const Vector&) const -> Vector;

void CheckedLU::compute(const Eigen::MatrixXd& matrix) {
    partial_.reset();
    if (matrix.rows() > many_states)
        partial_.emplace(matrix);
    else
        full_.compute(matrix);
}

Eigen::VectorXd CheckedLU::solve(const Eigen::VectorXd& right) const {
    return partial_ ? partial_->solve(right) : full_.solve(right);
}

bool CheckedLU::is_invertible() const {
    return partial_ ? partial_->is_regular() : full_.is_invertible();
}

double CheckedLU::determinant() const {
    return partial_ ? partial_->determinant() : full_.determinant();
}

PivotedQR::PivotedQR(const Eigen::MatrixXd& matrix, std::optional<double> threshold)
    : factors_(matrix.rows(), matrix.cols()) {
    if (threshold)
        factors_.setThreshold(*threshold);
    factors_.compute(matrix);
}

Eigen::VectorXd PivotedQR::solve(const Eigen::VectorXd& right) const {
    return factors_.solve(right);
}

Eigen::MatrixXd PivotedQR::solve_columns(const Eigen::MatrixXd& right) const {
    return factors_.solve(right);
}

Eigen::Index PivotedQR::rank() const {
    return factors_.rank();
}

double PivotedQR::pivot(Eigen::Index k) const {
    return factors_.matrixR()(k, k);
}

LeastSquares least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(matrix);
    return {factors.solve(right), factors.matrixQR().topRows(matrix.cols()).triangularView<Eigen::Upper>()};
}

Eigen::VectorXd shortest_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right,
                                  std::optional<double> threshold) {
    if (!matrix.allFinite() || !right.allFinite())
        return Eigen::VectorXd::Constant(matrix.cols(), not_a_number);
    const SingularValues factors = singular_values(matrix, SingularVectors::thin);
    const double round_off = epsilon * static_cast<double>(factors.values.size());
    const Eigen::Index rank = factors.rank(threshold.value_or(round_off));
    const Eigen::VectorXd along = factors.left.leftCols(rank).transpose() * right;
    return factors.right.leftCols(rank) * along.cwiseQuotient(factors.values.head(rank));
}

void make_triangular(Eigen::MatrixXd& matrix) {
    matrix = Eigen::HouseholderQR<Eigen::MatrixXd>(matrix).matrixQR();
}

Eigen::MatrixXd make_triangular_with(Eigen::MatrixXd& matrix, Eigen::MatrixXd& others) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(matrix);
    others.applyOnTheLeft(factors.householderQ().adjoint());
    Eigen::MatrixXd reflections = factors.matrixQR().triangularView<Eigen::UnitLower>();
    reflections *= factors.hCoeffs().cwiseSqrt().asDiagonal();
    matrix = factors.matrixQR().triangularView<Eigen::Upper>();
    return reflections;
}

double determinant(const Eigen::MatrixXd& matrix) {
    return matrix.determinant();
}

} // namespace graze
