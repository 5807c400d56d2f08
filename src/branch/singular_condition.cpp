#include "branch/singular_condition.hpp"

#include "orbit/eigen_index.hpp"

#include <cmath>
#include <optional>

namespace graze {

namespace {

/// Units of starts and durations, and those of the equations: of each piece its end condition's, then the states'.
Eigen::VectorXd units_of_columns(const OrbitEquations& equations, const OrbitEvaluation& at) {
    return at.scales.head(index(equations.layout().start_of(at.pieces.size())));
}

Eigen::VectorXd units_of_rows(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const auto n = index(equations.layout().states());
    Eigen::VectorXd result(index(at.pieces.size()) * (n + 1));
    for (std::size_t k = 0; k < at.pieces.size(); ++k)
        result.segment(index(k) * (n + 1), n + 1) << at.pieces[k].condition_unit, at.scales.head(n);
    return result;
}

} // namespace

MultiplierCondition::MultiplierCondition(const OrbitEquations& equations, const OrbitEvaluation& at)
    : variation_(equations), columns_(units_of_columns(equations, at)), rows_(units_of_rows(equations, at)) {}

CyclicMatrix MultiplierCondition::matrix(const OrbitEquations& equations, const OrbitEvaluation& at,
                                         double factor) const {
    return {at.system, factor, units_of_rows(equations, at).cwiseQuotient(rows_),
            columns_.cwiseQuotient(units_of_columns(equations, at))};
}

void MultiplierCondition::renew_units(const OrbitEquations& equations, const OrbitEvaluation& at,
                                      Eigen::VectorXd& right, Eigen::VectorXd& left) {
    const Eigen::VectorXd columns = units_of_columns(equations, at), rows = units_of_rows(equations, at);
    right = right.cwiseProduct(columns_).cwiseQuotient(columns).normalized();
    left = left.cwiseProduct(rows).cwiseQuotient(rows_).normalized();
    columns_ = columns;
    rows_ = rows;
}

bool MultiplierCondition::contract(const OrbitEquations& equations, const OrbitEvaluation& at,
                                   const Eigen::MatrixXd& left, const Eigen::VectorXd& right,
                                   Eigen::MatrixXd& gradients) {
    return variation_.contract(equations, at, rows_.cwiseInverse().asDiagonal() * left, right.cwiseProduct(columns_),
                               gradients);
}

SingularCondition::SingularCondition(const OrbitEquations& equations, const OrbitEvaluation& at, double multiplier)
    : MultiplierCondition(equations, at), multiplier_(multiplier) {}

std::unique_ptr<OrbitCondition> SingularCondition::of_multiplier(const OrbitEquations& equations,
                                                                 const OrbitEvaluation& at, double multiplier) {
    std::unique_ptr<SingularCondition> condition(new SingularCondition(equations, at, multiplier));
    if (!condition->matrix(equations, at, multiplier).null_vectors(condition->right_, condition->left_))
        return nullptr;
    return condition;
}

bool SingularCondition::evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) {
    Eigen::VectorXd right, left;
    Eigen::MatrixXd gradients;
    if (!matrix(equations, at, multiplier_).bordered(left_, right_, right, left, value_) ||
        !contract(equations, at, left, right, gradients))
        return false;
    gradient_ = -gradients.row(0);
    // How the value changes along the null vector: zero where not even the second derivatives part the orbits.
    if (multiplier_ > 0)
        degeneracy_ = gradient_.head(right.size()).dot(in_units(right)) / right.norm();
    return std::isfinite(value_) && gradient_.allFinite();
}

void SingularCondition::renew(const OrbitEquations& equations, const OrbitEvaluation& at) {
    Eigen::VectorXd right, left;
    double value = 0;
    if (!matrix(equations, at, multiplier_).bordered(left_, right_, right, left, value) || !right.allFinite() ||
        !left.allFinite())
        return; // those that it has are good for some time
    renew_units(equations, at, right, left);
    right_ = right;
    left_ = left;
}

TorusCondition::TorusCondition(const OrbitEquations& equations, const OrbitEvaluation& at,
                               std::complex<double> multiplier)
    : MultiplierCondition(equations, at), multiplier_(multiplier) {}

std::unique_ptr<OrbitCondition> TorusCondition::of_pair(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(index(equations.layout().start_of(at.pieces.size())));
    std::optional<std::complex<double>> nearest;
    const auto distance = [](std::complex<double> one) { return std::abs(std::log(std::abs(one))); };
    for (const std::complex<double> one : CyclicMatrix(at.system, 1, ones, ones).multipliers())
        if (one.imag() > 0 && (!nearest || distance(one) < distance(*nearest)))
            nearest = one;
    if (!nearest)
        return nullptr;
    return std::unique_ptr<OrbitCondition>(new TorusCondition(equations, at, *nearest));
}

bool TorusCondition::evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) {
    CyclicMatrix::Multiplier one;
    if (!matrix(equations, at, 1).multiplier_near(multiplier_, one) || !(one.value.imag() > 0))
        return false;
    multiplier_ = one.value;
    value_ = std::norm(one.value) - 1;
    // The multiplier changes by -l^T dA r; both vectors are complex.
    Eigen::MatrixXd left(one.left.size(), 2), by_real, by_imaginary;
    left << one.left.real(), one.left.imag();
    if (!contract(equations, at, left, one.right.real(), by_real) ||
        !contract(equations, at, left, one.right.imag(), by_imaginary))
        return false;
    const Eigen::RowVectorXd real = by_imaginary.row(1) - by_real.row(0),
                             imaginary = -by_real.row(1) - by_imaginary.row(0);
    gradient_ = 2 * (one.value.real() * real + one.value.imag() * imaginary);
    return std::isfinite(value_) && gradient_.allFinite();
}

} // namespace graze
