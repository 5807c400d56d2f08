#include "base/linear_systems.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/branch/continuation.hpp"
#include "orbit/eigen_index.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Cube root of the unit round-off, the optimal relative step of central differences.
constexpr double difference_step = 6e-6;

} // namespace

double ContinuationProblem::product(std::span<const double> a, std::span<const double> b) const {
    const auto scales = this->scales(), weights = this->weights();
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] / scales[i] * (b[i] / scales[i]) * (weights.empty() ? 1 : weights[i]);
    return sum;
}

double ContinuationProblem::length_of(std::span<const double> direction) const {
    return std::sqrt(product(direction, direction));
}

std::vector<double> ContinuationProblem::row_of(std::span<const double> direction) const {
    const auto scales = this->scales(), weights = this->weights();
    std::vector<double> row(direction.size());
    for (std::size_t i = 0; i < direction.size(); ++i)
        row[i] = direction[i] / (scales[i] * scales[i]) * (weights.empty() ? 1 : weights[i]);
    return row;
}

DenseProblem::DenseProblem(std::size_t unknowns, Map residuals, Map jacobian, std::vector<double> scales)
    : unknowns_(unknowns), residuals_(std::move(residuals)), jacobian_(std::move(jacobian)),
      scales_(std::move(scales)) {
    if (unknowns_ < 1 || !residuals_)
        throw InputError("a continuation problem needs unknowns and residuals", "give at least one unknown");
    if (scales_.empty())
        scales_.assign(unknowns_, 1);
    if (scales_.size() != unknowns_ || !vector_of(scales_).allFinite() || !(vector_of(scales_).minCoeff() > 0))
        throw InputError("the scales of a continuation problem do not fit", "give a positive one for each unknown");
    values_.resize(unknowns_ - 1);
    matrix_.resize((unknowns_ - 1) * unknowns_);
}

bool DenseProblem::evaluate(std::span<const double> u) {
    require_size(u.size(), unknowns_, "unknowns");
    evaluated_ = true;
    return residuals_(u, values_) && vector_of(values_).allFinite() &&
           (jacobian_ ? jacobian_(u, matrix_) : differences(u)) && vector_of(matrix_).allFinite();
}

bool DenseProblem::differences(std::span<const double> u) {
    std::vector<double> shifted(u.begin(), u.end()), above(values_.size()), below(values_.size());
    for (std::size_t j = 0; j < unknowns_; ++j) {
        const double step = difference_step * std::max(std::abs(u[j]), scales_[j]);
        shifted[j] = u[j] + step;
        const double high = shifted[j];
        if (!residuals_(shifted, above))
            return false;
        shifted[j] = u[j] - step;
        if (!residuals_(shifted, below))
            return false;
        for (std::size_t i = 0; i < values_.size(); ++i)
            matrix_[i * unknowns_ + j] = (above[i] - below[i]) / (high - shifted[j]);
        shifted[j] = u[j];
    }
    return true;
}

bool DenseProblem::solve(std::span<const double> row, double right, bool homogeneous, std::span<double> step,
                         double* determinant) {
    if (!evaluated_)
        throw OrderError("a problem has to be evaluated before it can be solved");
    require_size(row.size(), unknowns_, "numbers of a row");
    require_size(step.size(), unknowns_, "numbers of a step");
    const Eigen::Index n = index(unknowns_);
    Eigen::MatrixXd matrix(n, n);
    matrix.topRows(n - 1) = Eigen::Map<const RowMajor>(matrix_.data(), n - 1, n);
    matrix.row(n - 1) = vector_of(row).transpose();
    matrix *= vector_of(scales_).asDiagonal();
    Eigen::VectorXd values = Eigen::VectorXd::Zero(n);
    if (!homogeneous)
        values.head(n - 1) = -vector_of(values_);
    values[n - 1] = right;
    const FullLU<double> lu(matrix);
    if (determinant)
        *determinant = lu.determinant();
    if (!lu.is_invertible())
        return false;
    entries_of(step) = lu.solve(values).cwiseProduct(vector_of(scales_));
    return entries_of(step).allFinite();
}

} // namespace graze
