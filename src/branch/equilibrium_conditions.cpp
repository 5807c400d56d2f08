#include "branch/equilibrium_conditions.hpp"

#include "base/concatenated.hpp"
#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"
#include "orbit/eigen_index.hpp"

#include <cmath>
#include <limits>

namespace graze {

void FoldBorders::choose(const Eigen::MatrixXd& field, double size) {
    const SingularValues parts = singular_values(field, SingularVectors::full);
    const Eigen::Index last = field.rows() - 1;
    Eigen::VectorXd left = parts.left.col(last), right = parts.right.col(last);
    if (are_chosen()) {
        left *= left.dot(rows_) < 0 ? -1 : 1;
        right *= right.dot(columns_) < 0 ? -1 : 1;
    } else if (left.dot(right) < 0) {
        left = -left;
    }
    rows_ = left;
    columns_ = right;
    size_ = size;
}

std::optional<FoldBorders::Null> FoldBorders::at(const Eigen::MatrixXd& field) const {
    const Eigen::Index n = field.rows();
    Eigen::MatrixXd bordered(n + 1, n + 1);
    bordered << field / size_, rows_, columns_.transpose(), Eigen::MatrixXd::Zero(1, 1);
    const PartialLU factors(bordered);
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(n + 1, n);
    const Eigen::VectorXd right = factors.solve(unit), left = factors.solve_transposed(unit);
    if (!right.allFinite() || !left.allFinite())
        return std::nullopt;
    return Null{right[n] * size_, right.head(n), left.head(n)};
}

std::optional<EigenvaluePair> eigenvalue_pair(const Eigen::MatrixXd& field, double product) {
    const auto values = eigenvalues(field);
    if (!values || values->size() < 2)
        return std::nullopt;
    EigenvaluePair pair;
    double nearest = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < values->size(); ++i)
        for (Eigen::Index j = i + 1; j < values->size(); ++j) {
            const std::complex<double> sum = (*values)[i] + (*values)[j], both = (*values)[i] * (*values)[j];
            const bool is_real = std::abs(sum.imag()) <= 1e-12 * (std::abs((*values)[i]) + std::abs((*values)[j]));
            const double distance = std::norm(sum) + std::abs(both - product);
            if (is_real && distance < nearest) {
                nearest = distance;
                pair.sum = sum.real();
                pair.product = both.real();
            }
        }
    if (!std::isfinite(nearest))
        return std::nullopt;
    const Eigen::Index n = field.rows();
    const double size = field.norm();
    const Eigen::MatrixXd scaled = field / size;
    const SingularValues parts = singular_values(scaled * scaled - pair.sum / size * scaled +
                                                     pair.product / (size * size) * Eigen::MatrixXd::Identity(n, n),
                                                 SingularVectors::full);
    pair.right = parts.right.rightCols(2);
    const Eigen::MatrixXd left = parts.left.rightCols(2), gram = left.transpose() * pair.right;
    if (!(std::abs(gram.determinant()) > 0))
        return std::nullopt;
    pair.left = left * gram.inverse().transpose();
    const Eigen::MatrixXd within = pair.left.transpose() * field * pair.right;
    pair.sum = within.trace();
    pair.product = within.determinant();
    return pair;
}

bool EquilibriumFold::evaluate(const EquilibriumEvaluation& at, double& value, Eigen::VectorXd& gradient) {
    const auto null = borders_.at(at.field);
    if (!null)
        return false;
    value = null->value / size_;
    gradient = -(at.second(null->right).transpose() * null->left) / size_;
    return std::isfinite(value) && gradient.allFinite();
}

void EquilibriumFold::accept(const EquilibriumEvaluation& at) {
    size_ = at.jacobian.norm();
    borders_.choose(at.field, size_);
}

bool EquilibriumHopf::evaluate(const EquilibriumEvaluation& at, double& value, Eigen::VectorXd& gradient) {
    const auto pair = eigenvalue_pair(at.field, product_);
    if (!pair)
        return false;
    value = pair->sum / size_;
    gradient = Eigen::VectorXd::Zero(at.scales.size());
    for (Eigen::Index k = 0; k < 2; ++k)
        gradient += at.second(pair->right.col(k)).transpose() * pair->left.col(k) / size_;
    return std::isfinite(value) && gradient.allFinite();
}

void EquilibriumHopf::accept(const EquilibriumEvaluation& at) {
    size_ = at.field.norm();
    if (const auto pair = eigenvalue_pair(at.field, product_))
        product_ = pair->product;
}

bool HeldFunction::evaluate(const EquilibriumEvaluation& at, double& value, Eigen::VectorXd& gradient) {
    const std::vector<double> all = function_(concatenated(at.state, at.parameters));
    value = (all[0] - held_) / size_;
    gradient = at.gradient_of(std::span(all).subspan(1)) / size_;
    return std::isfinite(value) && gradient.allFinite();
}

void HeldFunction::accept(const EquilibriumEvaluation& at) {
    const std::vector<double> all = function_(concatenated(at.state, at.parameters));
    const double size = at.gradient_of(std::span(all).subspan(1)).norm();
    size_ = size > 0 && std::isfinite(size) ? size : 1;
}

} // namespace graze
