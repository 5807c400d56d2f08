#include "base/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>
#include <limits>

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
    if (matrix.size() == 0) // which Eigen cannot take
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
    const Eigen::JacobiSVD<Eigen::MatrixXd> factors(matrix, options);
    SingularValues result{factors.singularValues(), {}, {}};
    if (factors.computeU())
        result.left = factors.matrixU();
    if (factors.computeV())
        result.right = factors.matrixV();
    return result;
}

SingularValues singular_values_of_large(const Eigen::MatrixXd& matrix) {
    const Eigen::BDCSVD<Eigen::MatrixXd> factors(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return {factors.singularValues(), factors.matrixU(), factors.matrixV()};
}

Eigen::VectorXd singular_values(const Eigen::MatrixXcd& matrix) {
    return Eigen::JacobiSVD<Eigen::MatrixXcd>(matrix).singularValues();
}

Eigen::VectorXcd null_vector(const Eigen::MatrixXcd& matrix) {
    return Eigen::JacobiSVD<Eigen::MatrixXcd>(matrix, Eigen::ComputeFullV).matrixV().rightCols<1>();
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

std::optional<Eigen::VectorXd> symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix, Eigen::EigenvaluesOnly);
    if (solver.info() != Eigen::Success)
        return std::nullopt;
    return solver.eigenvalues();
}

std::optional<GeneralizedEigenvalues> generalized_eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    const Eigen::GeneralizedEigenSolver<Eigen::MatrixXd> solver(a, b, false);
    if (solver.info() != Eigen::Success)
        return std::nullopt;
    return GeneralizedEigenvalues{solver.alphas(), solver.betas()};
}

std::optional<SchurForm> schur_form(const Eigen::MatrixXd& matrix) {
    const Eigen::ComplexSchur<Eigen::MatrixXcd> schur(matrix.cast<std::complex<double>>());
    if (schur.info() != Eigen::Success)
        return std::nullopt;
    return SchurForm{schur.matrixU(), schur.matrixT()};
}

OrthogonalFactors orthogonal_factors(const Eigen::MatrixXd& matrix) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> factors(matrix);
    const Eigen::Index rows = std::min(matrix.rows(), matrix.cols());
    return {factors.householderQ() * Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()),
            factors.matrixQR().topRows(rows).triangularView<Eigen::Upper>()};
}

} // namespace graze
