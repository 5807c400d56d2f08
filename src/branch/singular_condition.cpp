#include "branch/singular_condition.hpp"

#include "branch/normal_form.hpp"
#include "orbit/eigen_index.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

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

using Multipliers = std::vector<std::complex<double>>;

/// Two that belong together, conjugate or both real, whose sum and product are nearest to these.
std::optional<std::pair<std::complex<double>, std::complex<double>>> pair_near(const Multipliers& all, double sum,
                                                                               double product) {
    std::optional<std::pair<std::complex<double>, std::complex<double>>> result;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = i + 1; j < all.size(); ++j) {
            const double distance = std::abs(all[i] + all[j] - sum) + std::abs(all[i] * all[j] - product);
            if ((all[i].imag() == 0) == (all[j].imag() == 0) && distance < nearest) {
                nearest = distance;
                result = {all[i], all[j]};
            }
        }
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
    along_ = gradient_.head(right.size()).dot(in_units(right)) / right.norm();
    simplicity_ = matrix(equations, at, multiplier_).closing_product(left, right) / (left.norm() * right.norm());
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

std::vector<Degeneracy> SingularCondition::degeneracies(const OrbitEquations& equations, const OrbitEvaluation& at) {
    if (multiplier_ > 0)
        return {{PointType::cusp, along_}, {PointType::resonance_1, simplicity_}};
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    return {{PointType::generalised, flip_coefficient(equations, at).value_or(nothing)},
            {PointType::resonance_2, simplicity_}};
}

TorusCondition::TorusCondition(const OrbitEquations& equations, const OrbitEvaluation& at, double sum, double product)
    : MultiplierCondition(equations, at), sum_(sum), product_(product) {}

std::unique_ptr<OrbitCondition> TorusCondition::of_pair(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(index(equations.layout().start_of(at.pieces.size())));
    const auto one = pair_on_circle(CyclicMatrix(at.system, 1, ones, ones).multipliers());
    if (!one)
        return nullptr;
    return std::unique_ptr<OrbitCondition>(new TorusCondition(equations, at, 2 * one->real(), std::norm(*one)));
}

bool TorusCondition::evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const CyclicMatrix here = matrix(equations, at, 1);
    const auto pair = pair_near(here.multipliers(), sum_, product_);
    CyclicMatrix::Multiplier first, second;
    Eigen::RowVectorXcd by_first, by_second;
    if (!pair || !here.multiplier_near(pair->first, first) || !change_of(equations, at, first, by_first))
        return false;
    if (pair->first.imag() != 0) {
        gradient_ = 2 * (std::conj(first.value) * by_first).real();
    } else {
        if (!here.multiplier_near(pair->second, second) || !change_of(equations, at, second, by_second))
            return false;
        gradient_ = (first.value * by_second + second.value * by_first).real();
    }
    sum_ = (pair->first + pair->second).real();
    product_ = (pair->first * pair->second).real();
    value_ = product_ - 1;
    return std::isfinite(value_) && gradient_.allFinite();
}

/// A multiplier changes by -l^T dA r; both vectors may be complex.
bool TorusCondition::change_of(const OrbitEquations& equations, const OrbitEvaluation& at,
                               const CyclicMatrix::Multiplier& one, Eigen::RowVectorXcd& change) {
    Eigen::MatrixXd left(one.left.size(), 2), by_real, by_imaginary;
    left << one.left.real(), one.left.imag();
    if (!contract(equations, at, left, one.right.real(), by_real) ||
        !contract(equations, at, left, one.right.imag(), by_imaginary))
        return false;
    change.resize(by_real.cols());
    change.real() = by_imaginary.row(1) - by_real.row(0);
    change.imag() = -by_real.row(1) - by_imaginary.row(0);
    return true;
}

std::vector<Degeneracy> TorusCondition::degeneracies(const OrbitEquations&, const OrbitEvaluation&) {
    return {{PointType::resonance_1, sum_ - 2},
            {PointType::resonance_2, sum_ + 2},
            {PointType::resonance_3, sum_ + 1},
            {PointType::resonance_4, sum_}};
}

} // namespace graze
