#include "base/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace graze {

Eigen::Index SingularValues::rank(double threshold) const {
    if (values.size() == 0)
        return 0;
    const double least = std::max(values[0] * threshold, std::numeric_limits<double>::min());
    Eigen::Index result = values.size();
    while (result > 0 && values[result - 1] < least)
        --result;
    return result;
}

SingularValues singular_values(const Eigen::MatrixXd& matrix, SingularVectors vectors) {
    if (matrix.size() == 0) // Eigen cannot decompose an empty matrix
        return {{},
                Eigen::MatrixXd::Identity(matrix.rows(), matrix.rows()),
                Eigen::MatrixXd::Identity(matrix.cols(), matrix.cols())};
    unsigned int options = 0;
    if (vectors == SingularVectors::right)
        options = Eigen::ComputeFullV;
    else if (vectors == SingularVectors::full)
        options = Eigen::ComputeFullU | Eigen::ComputeFullV;
    else if (vectors == SingularVectors::thin)
        options = Eigen::ComputeThinU | Eigen::ComputeThinV;
    // Eigen 3.4's BDCSVD is ten times as fast for some hundred columns, but fails for some matrices of low rank.
    const Eigen::JacobiSVD<Eigen::MatrixXd> factors(matrix, options);
    SingularValues result{factors.singularValues(), {}, {}};
    if (factors.computeU())
        result.left = factors.matrixU();
    if (factors.computeV())
        result.right = factors.matrixV();
    return result;
}

namespace {

/// Returns the real matrix that acts on stacked real and imaginary parts as the complex matrix does.
Eigen::MatrixXd real_form(const Eigen::MatrixXcd& matrix) {
    Eigen::MatrixXd result(2 * matrix.rows(), 2 * matrix.cols());
    result << matrix.real(), -matrix.imag(), matrix.imag(), matrix.real();
    return result;
}

} // namespace

// The real form has each singular value of the complex matrix twice.
Eigen::VectorXd singular_values(const Eigen::MatrixXcd& matrix) {
    const Eigen::VectorXd twice = singular_values(real_form(matrix), SingularVectors::none).values;
    return Eigen::VectorXd::NullaryExpr(twice.size() / 2, [&](Eigen::Index i) { return twice[2 * i]; });
}

Eigen::VectorXcd null_vector(const Eigen::MatrixXcd& matrix) {
    if (matrix.imag().isZero(0)) // then the null vector is real as well
        return singular_values(matrix.real(), SingularVectors::right).right.rightCols<1>().cast<std::complex<double>>();
    const Eigen::MatrixXd right = singular_values(real_form(matrix), SingularVectors::right).right;
    Eigen::VectorXcd result(matrix.cols());
    result.real() = right.col(right.cols() - 1).head(matrix.cols());
    result.imag() = right.col(right.cols() - 1).tail(matrix.cols());
    return result;
}

std::optional<Eigensystem> eigensystem(const Eigen::MatrixXd& matrix) {
    if (matrix.size() == 0)
        return Eigensystem{};
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
    if (solver.info() != Eigen::Success)
        return std::nullopt;
    return Eigensystem{solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& matrix) {
    if (matrix.size() == 0)
        return Eigen::VectorXcd();
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
    if (solver.info() != Eigen::Success)
        return std::nullopt;
    return solver.eigenvalues();
}

Eigen::VectorXcd eigenvalues_or_nan(const Eigen::MatrixXd& matrix) {
    auto found = eigenvalues(matrix);
    return found ? std::move(*found)
                 : Eigen::VectorXcd::Constant(matrix.rows(), std::numeric_limits<double>::quiet_NaN());
}

std::optional<Eigen::VectorXd> symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
    if (solver.info() != Eigen::Success)
        return std::nullopt;
    return solver.eigenvalues();
}

// Eigen::GeneralizedEigenSolver does the same and takes longer to compile than all else here: its eigenvectors are
// compiled too.
std::optional<GeneralizedEigenvalues> generalized_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    Eigen::RealQZ<Eigen::MatrixXd> factors(a.rows());
    factors.compute(a, b, false);
    if (factors.info() != Eigen::Success)
        return std::nullopt;
    const Eigen::MatrixXd &s = factors.matrixS(), &t = factors.matrixT();
    GeneralizedEigenvalues result{Eigen::VectorXcd(a.rows()), Eigen::VectorXd(a.rows())};
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
        if (i + 1 == a.rows() || s(i + 1, i) == 0) {
            result.numerators[i] = s(i, i);
            result.denominators[i] = t(i, i);
            continue;
        }
        // A complex pair: a full block of two rows of s over a diagonal one of t.
        const double first = s(i, i) * t(i + 1, i + 1), second = s(i + 1, i + 1) * t(i, i);
        const double denominator = t(i, i) * t(i + 1, i + 1), half = 0.5 * (first - second);
        const double imaginary = std::sqrt(std::abs(half * half + s(i + 1, i) * s(i, i + 1) * denominator));
        result.numerators[i] = {second + half, imaginary};
        result.numerators[i + 1] = {second + half, -imaginary};
        result.denominators[i] = result.denominators[i + 1] = denominator;
        ++i;
    }
    return result;
}

// From the real form, with a rotation for each of its blocks of two rows: Eigen::ComplexSchur takes a third of the time
// of all else here to compile.
std::optional<SchurForm> schur_form(const Eigen::MatrixXd& matrix) {
    const Eigen::RealSchur<Eigen::MatrixXd> real(matrix);
    if (real.info() != Eigen::Success)
        return std::nullopt;
    SchurForm result{real.matrixU().cast<std::complex<double>>(), real.matrixT().cast<std::complex<double>>()};
    for (Eigen::Index i = 0; i + 1 < matrix.rows(); ++i) {
        const Eigen::Matrix2d block = real.matrixT().block<2, 2>(i, i);
        if (block(1, 0) == 0)
            continue;
        const double half = 0.5 * (block(0, 0) - block(1, 1)), square = half * half + block(0, 1) * block(1, 0);
        // An eigenvector of the block: the first column of the rotation.
        const std::complex<double> above = half + std::sqrt(std::complex<double>(square));
        const double length = std::hypot(above.real(), above.imag(), block(1, 0));
        const std::complex<double> first = above / length;
        const double second = block(1, 0) / length;
        Eigen::Matrix2cd rotation;
        rotation << first, -second, second, std::conj(first);
        result.triangle.middleRows<2>(i) = (rotation.adjoint() * result.triangle.middleRows<2>(i)).eval();
        result.triangle.middleCols<2>(i) = (result.triangle.middleCols<2>(i) * rotation).eval();
        result.unitary.middleCols<2>(i) = (result.unitary.middleCols<2>(i) * rotation).eval();
        result.triangle(i + 1, i) = 0;
    }
    return result;
}

OrthogonalFactors orthogonal_factors(const Eigen::MatrixXd& matrix) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(matrix);
    const Eigen::Index rows = std::min(matrix.rows(), matrix.cols());
    return {factors.householderQ() * Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()),
            factors.matrixQR().topRows(rows).triangularView<Eigen::Upper>()};
}

Eigen::MatrixXd orthogonal_complement(const Eigen::VectorXd& vector) {
    const Eigen::Index n = vector.size();
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(vector);
    const Eigen::MatrixXd all = factors.householderQ() * Eigen::MatrixXd::Identity(n, n);
    return all.rightCols(n - 1);
}

Eigen::MatrixXd between_complements(const Eigen::VectorXd& left, const Eigen::MatrixXd& matrix,
                                    const Eigen::VectorXd& right) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> before(left), after(right);
    Eigen::MatrixXd result = matrix;
    result.applyOnTheLeft(before.householderQ().adjoint());
    result.applyOnTheRight(after.householderQ());
    return result.bottomRightCorner(matrix.rows() - 1, matrix.cols() - 1);
}

NearlyNull nearly_null(const Eigen::MatrixXd& matrix) {
    const Eigen::Index rows = matrix.rows();
    const Eigen::MatrixXd transposed = matrix.transpose();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(transposed);
    const Eigen::MatrixXd all = factors.householderQ() * Eigen::MatrixXd::Identity(rows + 1, rows + 1);
    NearlyNull result;
    result.right = all.rightCols(2);
    // The left null vector is the combination of rows in which only the last pivot is left.
    Eigen::VectorXd weights(rows);
    weights[rows - 1] = 1;
    weights.head(rows - 1) = -factors.matrixQR().col(rows - 1).head(rows - 1);
    factors.matrixQR()
        .topLeftCorner(rows - 1, rows - 1)
        .triangularView<Eigen::Upper>()
        .solveInPlace(weights.head(rows - 1));
    result.left = (factors.colsPermutation() * weights).normalized();
    return result;
}

} // namespace graze
