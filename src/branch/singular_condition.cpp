#include "branch/singular_condition.hpp"

#include "branch/normal_form.hpp"
#include "orbit/eigen_index.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace graze {

namespace {

using Multipliers = std::vector<std::complex<double>>;
using Pair = std::pair<std::complex<double>, std::complex<double>>;

/// Returns the pair, conjugate or both real, whose product and sum are nearest to the given ones. Products are compared
/// by their ratio, since that of the kept pair is constant, sums by their difference.
std::optional<Pair> pair_near(const Multipliers& all, double sum, double product) {
    std::optional<Pair> result;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = i + 1; j < all.size(); ++j) {
            const double distance = std::abs(std::log(std::abs(all[i] * all[j]) / std::abs(product))) +
                                    0.5 * std::abs(all[i] + all[j] - sum);
            if ((all[i].imag() == 0) == (all[j].imag() == 0) && distance < nearest) {
                nearest = distance;
                result = {all[i], all[j]};
            }
        }
    return result;
}

/// Returns the complex pair nearest to the unit circle, or two nearly equal real multipliers there if these are nearer.
std::optional<Pair> pair_to_keep(const Multipliers& all) {
    constexpr double meeting = 0.01; // distance from 1 or -1: double multipliers differ by the square root of round-off
    std::optional<Pair> result;
    double nearest = std::numeric_limits<double>::infinity();
    const auto note = [&](std::complex<double> one, std::complex<double> other) {
        const double off = std::abs(std::log(std::abs(one * other)));
        if (off < nearest) {
            nearest = off;
            result = {one, other};
        }
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].imag() > 0)
            note(all[i], std::conj(all[i]));
        for (std::size_t j = i + 1; all[i].imag() == 0 && j < all.size(); ++j)
            if (all[j].imag() == 0 && std::abs(std::abs(all[i].real()) - 1) < meeting &&
                std::abs(all[i] - all[j]) < meeting)
                note(all[i], all[j]);
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
        return; // keep the previous vectors
    renew_units(equations, at, right, left);
    right_ = right;
    left_ = left;
}

std::vector<Degeneracy> SingularCondition::degeneracies(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                        std::optional<PointType> only) {
    // Relative to the vectors' lengths. In area-preserving models the multiplier is double all along the curve.
    constexpr double least_product = 1e-9;
    if (multiplier_ > 0)
        return {{PointType::cusp, along_}, {PointType::resonance_1, simplicity_, least_product}};
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    const bool needs_form = !only || *only == PointType::generalised;
    const auto form = needs_form ? flip_criticality(equations, at, variation()) : std::nullopt;
    return {{PointType::generalised, form && form->is_simple ? form->value() : nothing},
            {PointType::resonance_2, simplicity_, least_product}};
}

TorusCondition::TorusCondition(const OrbitEquations& equations, const OrbitEvaluation& at, double sum, double product)
    : MultiplierCondition(equations, at), sum_(sum), product_(product), kept_sum_(sum), kept_product_(product) {}

std::unique_ptr<OrbitCondition> TorusCondition::of_pair(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const auto pair = pair_to_keep(multipliers_of(equations, at));
    if (!pair)
        return nullptr;
    const double sum = (pair->first + pair->second).real(), product = (pair->first * pair->second).real();
    return std::unique_ptr<OrbitCondition>(new TorusCondition(equations, at, sum, product));
}

/// Uses the invariant plane of the pair, which is smooth where the two multipliers meet.
bool TorusCondition::evaluate(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const CyclicMatrix here = matrix(equations, at, 1);
    const auto pair = pair_near(here.multipliers(), kept_sum_, kept_product_);
    CyclicMatrix::Plane plane;
    if (!pair || !here.plane_near(pair->first, pair->second, plane))
        return false;
    gradient_ = Eigen::RowVectorXd::Zero(at.unknowns.size());
    for (Eigen::Index j = 0; j < 2; ++j) {
        Eigen::MatrixXd changes; // derivatives of column j of the map, with opposite sign
        if (!contract(equations, at, plane.left, plane.right.col(j), changes))
            return false;
        const Eigen::Index k = 1 - j; // derivative of the determinant by the entries of that column
        gradient_ -= plane.map(k, k) * changes.row(j) - plane.map(j, k) * changes.row(k);
    }
    sum_ = plane.map.trace();
    product_ = plane.map.determinant();
    value_ = product_ - 1;
    return std::isfinite(value_) && gradient_.allFinite();
}

void TorusCondition::renew(const OrbitEquations&, const OrbitEvaluation&) {
    kept_sum_ = sum_;
    kept_product_ = product_;
}

std::vector<Degeneracy> TorusCondition::degeneracies(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                     std::optional<PointType> only) {
    // Relative error of third derivatives. In conservative models the real part is only round-off, which grows towards
    // the resonances at 1 and -1, where the two multipliers coincide.
    constexpr double digits = 1e-5, least_apart = 1e-6;
    const double apart = 1 - sum_ * sum_ / 4; // the square of the imaginary part
    const bool needs_form = (!only || *only == PointType::generalised_torus) && apart > least_apart;
    const auto form = needs_form ? torus_criticality(equations, at, variation()) : std::nullopt;
    const Degeneracy generalised =
        form ? Degeneracy{PointType::generalised_torus, form->value(), digits * std::abs(form->form) / apart}
             : Degeneracy{PointType::generalised_torus, std::numeric_limits<double>::quiet_NaN()};
    return {{PointType::resonance_1, sum_ - 2},
            {PointType::resonance_2, sum_ + 2},
            {PointType::resonance_3, sum_ + 1},
            {PointType::resonance_4, sum_},
            generalised};
}

} // namespace graze
