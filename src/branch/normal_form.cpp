#include "branch/normal_form.hpp"

#include "base/linear_systems.hpp"
#include "orbit/cyclic_matrix.hpp"
#include "orbit/eigen_index.hpp"
#include "orbit/second_variation.hpp"

#include <Eigen/Core>

#include <cmath>

namespace graze {

namespace {

using Complex = std::complex<double>;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::RowVectorXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// Taylor expansion of the scaled equations about an orbit.
class Expansion {
public:
    /// Largest number of unknowns for which dense matrices are used.
    static constexpr std::size_t most_unknowns = 600;

    Expansion(const OrbitEquations& equations, const OrbitEvaluation& at, SecondVariation& variation)
        : equations_(equations), shifted_(at), variation_(variation), columns_(units_of_columns(equations, at)),
          rows_(units_of_rows(equations, at)), fixed_(MatrixXd::Zero(columns_.size(), columns_.size())),
          closing_(fixed_) {
        const auto n = index(equations.layout().states()), pieces = index(at.pieces.size());
        for (Eigen::Index k = 0; k < pieces; ++k) { // blocks are already scaled
            const CyclicSystem::Block& block = at.system.block(static_cast<std::size_t>(k));
            const Eigen::Index place = k * (n + 1);
            fixed_.block(place, place, n + 1, n + 1) += block.own;
            const bool closes = k + 1 == pieces;
            (closes ? closing_ : fixed_).block(place, closes ? 0 : place + n + 1, n + 1, n) += block.next;
        }
    }

    MatrixXcd closed_by(Complex factor) const { return fixed_ + factor * closing_; }
    const MatrixXd& closing() const { return closing_; }
    /// Returns the length of the first start of a vector, in the model's units.
    double length_of_start(const VectorXcd& vector) const {
        const auto n = index(equations_.layout().states());
        return vector.head(n).cwiseProduct(columns_.head(n)).norm();
    }

    /// Computes l^T F_2(v, v) and the magnitude of its terms. @return false where the motion cannot be followed
    bool second(const VectorXd& left, const VectorXd& vector, double& result, double& parts) {
        MatrixXd gradient;
        if (!contract(left, vector, gradient))
            return false;
        result = gradient.row(0).dot(vector);
        parts = gradient.norm() * vector.norm();
        return std::isfinite(result);
    }
    /// Returns l^T F_p for the first free parameter, in its own unit.
    double by_parameter(const VectorXd& left, const OrbitEvaluation& at) const {
        const auto rows = index(equations_.layout().states()) + 1;
        double sum = 0;
        for (Eigen::Index k = 0; k < index(at.pieces.size()); ++k)
            sum += left.segment(k * rows, rows).dot(at.system.block(static_cast<std::size_t>(k)).parameters.col(0));
        return sum / at.scales[index(equations_.layout().parameter(0))];
    }
    /// Returns the first start of a vector, and the row that maps a change of the start to its closing defect, in the
    /// model's units.
    VectorXd start_along(const VectorXd& vector) const {
        const auto n = index(equations_.layout().states());
        return vector.head(n).cwiseProduct(columns_.head(n));
    }
    VectorXd closing_row(const VectorXd& left) const {
        const auto n = index(equations_.layout().states());
        return (closing_.leftCols(n).transpose() * left).cwiseQuotient(columns_.head(n));
    }

    /// Computes the matrix F_2(v, .). @return false where the motion cannot be followed
    bool second(const VectorXcd& vector, MatrixXcd& result) {
        const auto count = columns_.size();
        MatrixXd real, imaginary = MatrixXd::Zero(count, count);
        if (!contract(MatrixXd::Identity(count, count), vector.real(), real) ||
            (vector.imag().squaredNorm() > 0 && !contract(MatrixXd::Identity(count, count), vector.imag(), imaginary)))
            return false;
        result = real + Complex(0, 1) * imaginary;
        return true;
    }

    /// Computes l^T F_3(v, v, .) by fourth-order differences. @param parts incremented by the magnitudes of the terms
    bool third(const VectorXcd& left, const VectorXd& vector, RowVectorXcd& result, double& parts) {
        constexpr double share = 1e-3; // step in scaled unknowns, whatever the length of the vector
        const double size = vector.cwiseAbs().maxCoeff();
        result = RowVectorXcd::Zero(columns_.size());
        if (size == 0)
            return true;
        std::optional<Difference> difference = differences(left, vector, share / size);
        if (!has_scale(vector))
            difference = confirmed(std::move(difference), left, vector, share / size);
        if (!difference)
            return false;
        result = difference->value;
        parts += difference->parts;
        return true;
    }

private:
    struct Difference {
        RowVectorXcd value;
        double parts = 0;
    };
    std::optional<Difference> differences(const VectorXcd& left, const VectorXd& vector, double step) {
        Difference result;
        MatrixXd weights(left.size(), 2), one, sum = MatrixXd::Zero(2, columns_.size());
        weights << left.real(), left.imag();
        const VectorXd here = shifted_.unknowns;
        const auto at = [&](double length, double weight) {
            shifted_.unknowns.head(columns_.size()) += length * columns_.cwiseProduct(vector);
            const bool followed = contract(weights, vector, one);
            shifted_.unknowns = here;
            if (followed) {
                sum += weight / (12 * step) * one;
                result.parts += std::abs(weight) / (12 * step) * one.norm();
            }
            return followed;
        };
        if (!at(step, 8) || !at(-step, -8) || !at(2 * step, -1) || !at(-2 * step, 1))
            return std::nullopt;
        result.value = sum.row(0) + Complex(0, 1) * sum.row(1);
        return result;
    }
    /// True when the orbit itself tells how large a displacement along a vector may be: some start is not zero in it.
    bool has_scale(const VectorXd& vector) const {
        constexpr double least = 1e-3; // of the scale, and of the vector
        const double size = vector.cwiseAbs().maxCoeff();
        for (Eigen::Index i = 0; i < columns_.size(); ++i)
            if (std::abs(vector[i]) > least * size && std::abs(shifted_.unknowns[i]) > least * columns_[i])
                return true;
        return false;
    }
    /// Returns the difference by the longest step, from one downwards, that a shorter one confirms; if there is none,
    /// that by the step itself.
    std::optional<Difference> confirmed(std::optional<Difference> first, const VectorXcd& left, const VectorXd& vector,
                                        double step) {
        constexpr double shorter = 0.03, same = 1e-4, round_off = 1e-9;
        constexpr int most = 12;
        std::vector<std::optional<Difference>> all;
        all.push_back(std::move(first));
        for (int i = 1; i < most; ++i) {
            step *= shorter;
            all.push_back(differences(left, vector, step));
            std::optional<Difference>&before = *(all.end() - 2), &here = all.back();
            if (here && before &&
                (here->value - before->value).norm() <= same * here->value.norm() + round_off * here->parts)
                return std::move(before);
        }
        return std::move(all.front());
    }

    bool contract(const MatrixXd& left, const VectorXd& right, MatrixXd& result) {
        MatrixXd gradients;
        if (!variation_.contract(equations_, shifted_, rows_.cwiseInverse().asDiagonal() * left,
                                 right.cwiseProduct(columns_), gradients))
            return false;
        result = gradients.leftCols(columns_.size()) * columns_.asDiagonal();
        return true;
    }

    const OrbitEquations& equations_;
    OrbitEvaluation shifted_;
    SecondVariation& variation_;
    VectorXd columns_, rows_;  ///< units of starts and durations, and of the equations
    MatrixXd fixed_, closing_; ///< A(mu) = fixed + mu closing
};

/// Computes the right and left null vectors of a singular matrix by bordering (Govaerts 2000).
void null_vectors(const MatrixXcd& matrix, VectorXcd& right, VectorXcd& left) {
    const Eigen::Index count = matrix.rows();
    MatrixXcd bordered = MatrixXcd::Zero(count + 1, count + 1);
    bordered.topLeftCorner(count, count) = matrix;
    for (Eigen::Index i = 0; i < count; ++i) {
        bordered(i, count) = std::cos(2.4 * static_cast<double>(i));
        bordered(count, i) = std::cos(1.7 * static_cast<double>(i) + 1);
    }
    const VectorXcd last = VectorXcd::Unit(count + 1, count);
    for (int repetition = 0; repetition < 2;
         ++repetition) { // the second pass uses the null vectors as well-conditioned borders
        right = ComplexLU(bordered).solve(last).head(count).normalized();
        left = ComplexLU(bordered.transpose()).solve(last).head(count).normalized();
        bordered.col(count).head(count) = left.conjugate();
        bordered.row(count).head(count) = right.adjoint();
    }
}

/// Relative error of values computed from derivatives, against their largest terms.
constexpr double round_off_of_product = 1e-12;
/// Relative size of the product of both null vectors below which the multiplier counts as multiple; the null vectors of
/// a located point are less accurate than round-off.
constexpr double least_product_of_vectors = 1e-9;

/// Computes F_3(q, q, q*) + 2 F_2(q, z_11) + F_2(q*, z_20), projected on the critical direction. z_11 and z_20 are the
/// second-order corrections of the mean and of the second harmonic.
std::optional<Criticality> cubic_coefficient(const OrbitEquations& equations, const OrbitEvaluation& at,
                                             Complex multiplier, SecondVariation& variation) {
    if (equations.layout().start_of(at.pieces.size()) > Expansion::most_unknowns)
        return std::nullopt;
    Expansion expansion(equations, at, variation);
    VectorXcd q, left;
    null_vectors(expansion.closed_by(multiplier), q, left);
    q /= expansion.length_of_start(q);
    const Complex product = left.transpose() * (expansion.closing() * q);
    const VectorXcd conjugate = q.conjugate();
    MatrixXcd with_q;
    RowVectorXcd with_real, with_imaginary = RowVectorXcd::Zero(q.size());
    double parts = 0;
    if (!q.allFinite() || !expansion.second(q, with_q) || !expansion.third(left, q.real(), with_real, parts) ||
        (multiplier.imag() != 0 && !expansion.third(left, q.imag(), with_imaginary, parts)))
        return std::nullopt;
    const ComplexLU at_rest(expansion.closed_by(1)), twice(expansion.closed_by(multiplier * multiplier));
    const VectorXcd square = with_q * q, modulus = with_q * conjugate;
    const VectorXcd mean = -at_rest.solve(modulus), second = -twice.solve(square);
    // With q = a + i b, q q q* = (a a + b b) (a + i b), and F_2 is real.
    const VectorXcd from_second = with_q.conjugate() * second + 2.0 * with_q * mean;
    const Complex third = (with_real + with_imaginary) * q, rest = left.transpose() * from_second;
    // Propagate the round-off of F_2(q, q) and F_2(q, q*) through the mean and the second harmonic.
    const double size = with_q.norm() * q.norm();
    const VectorXcd by_mean = with_q.transpose() * left, by_second = with_q.adjoint() * left;
    const VectorXcd mean_spread = at_rest.solve_transposed(by_mean), second_spread = twice.solve_transposed(by_second);
    const double spread = 2 * mean_spread.norm() + second_spread.norm();
    const double error = spread * size + with_q.norm() * (second.norm() + 2 * mean.norm()) + parts * q.norm();
    const bool is_simple =
        std::abs(product) > least_product_of_vectors * left.norm() * (expansion.closing() * q).norm();
    const Criticality result{-(third + rest) / product, round_off_of_product * error / std::abs(product), is_simple};
    if (!std::isfinite(result.form.real()) || !std::isfinite(result.form.imag()) || !std::isfinite(result.error))
        return std::nullopt;
    return result;
}

/// The null vectors at a multiplier 1, the right one with a first start of length 1, and their product.
struct Fold {
    Fold(const Expansion& expansion, const MatrixXcd& matrix) {
        VectorXcd complex_right, complex_left;
        null_vectors(matrix, complex_right, complex_left);
        complex_right /= expansion.length_of_start(complex_right);
        right = complex_right.real();
        left = complex_left.real();
        product = left.dot(expansion.closing() * right);
    }
    VectorXd right, left;
    double product = 0;
};

} // namespace

std::optional<FoldForm> fold_form(const OrbitEquations& equations, const OrbitEvaluation& at,
                                  SecondVariation& variation) {
    if (equations.layout().start_of(at.pieces.size()) > Expansion::most_unknowns || equations.free().empty())
        return std::nullopt;
    Expansion expansion(equations, at, variation);
    const Fold fold(expansion, expansion.closed_by(1));
    double second = 0, parts = 0;
    if (!fold.right.allFinite() || !expansion.second(fold.left, fold.right, second, parts))
        return std::nullopt;
    constexpr double least = 1e-9; // share of the terms of the second derivative
    const bool is_simple = std::abs(fold.product) >
                           least_product_of_vectors * fold.left.norm() * (expansion.closing() * fold.right).norm();
    // The equations are the next start minus the image of this one, hence the minus signs.
    const double coefficient = -second / (2 * fold.product), sign = coefficient < 0 ? -1 : 1;
    const double rate = -sign * expansion.by_parameter(fold.left, at) / fold.product;
    if (!std::isfinite(coefficient) || !std::isfinite(rate))
        return std::nullopt;
    const VectorXd critical = sign * expansion.start_along(fold.right),
                   adjoint = sign / fold.product * expansion.closing_row(fold.left);
    const bool above = rate<0, turns = std::abs(second)> least * parts;
    return FoldForm{.coefficient = sign * coefficient,
                    .above = above,
                    .turns = turns,
                    .is_simple = is_simple,
                    .rate = rate,
                    .critical = numbers_of(critical),
                    .adjoint = numbers_of(adjoint)};
}

/// Like the coefficient of a flip, but the second-order correction is solved in a bordered system, because the matrix
/// is singular along the null vector.
std::optional<double> cusp_coefficient(const OrbitEquations& equations, const OrbitEvaluation& at,
                                       SecondVariation& variation) {
    const auto count = index(equations.layout().start_of(at.pieces.size()));
    if (static_cast<std::size_t>(count) > Expansion::most_unknowns)
        return std::nullopt;
    Expansion expansion(equations, at, variation);
    const MatrixXcd matrix = expansion.closed_by(1);
    const Fold fold(expansion, matrix);
    MatrixXcd with_right;
    RowVectorXcd third;
    double parts = 0;
    if (!fold.right.allFinite() || !expansion.second(fold.right, with_right) ||
        !expansion.third(fold.left.cast<Complex>(), fold.right, third, parts))
        return std::nullopt;
    MatrixXd bordered = MatrixXd::Zero(count + 1, count + 1);
    bordered.topLeftCorner(count, count) = matrix.real();
    bordered.col(count).head(count) = fold.left;
    bordered.row(count).head(count) = fold.right.transpose();
    VectorXd square = VectorXd::Zero(count + 1);
    square.head(count) = -with_right.real() * fold.right;
    const VectorXd correction = PartialLU(bordered).solve(square).head(count);
    const double cubic = third.real().dot(fold.right.transpose()) + 3 * fold.left.dot(with_right.real() * correction);
    const double result = -cubic / (6 * fold.product);
    return std::isfinite(result) ? std::optional(result) : std::nullopt;
}

std::optional<Criticality> flip_criticality(const OrbitEquations& equations, const OrbitEvaluation& at,
                                            SecondVariation& variation) {
    auto cubic = cubic_coefficient(equations, at, -1, variation);
    if (cubic)
        *cubic = {cubic->form / 6.0, cubic->error / 6, cubic->is_simple};
    return cubic;
}

std::optional<Criticality> torus_criticality(const OrbitEquations& equations, const OrbitEvaluation& at,
                                             SecondVariation& variation) {
    const auto multiplier = pair_on_circle(multipliers_of(equations, at));
    auto cubic = multiplier ? cubic_coefficient(equations, at, *multiplier, variation) : std::nullopt;
    if (cubic)
        *cubic = {std::conj(*multiplier) * cubic->form / 2.0, cubic->error / 2, cubic->is_simple};
    return cubic;
}

VectorXd units_of_columns(const OrbitEquations& equations, const OrbitEvaluation& at) {
    return at.scales.head(index(equations.layout().start_of(at.pieces.size())));
}

VectorXd units_of_rows(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const auto n = index(equations.layout().states());
    VectorXd result(index(at.pieces.size()) * (n + 1));
    for (std::size_t k = 0; k < at.pieces.size(); ++k)
        result.segment(index(k) * (n + 1), n + 1) << at.pieces[k].condition_unit, at.scales.head(n);
    return result;
}

std::vector<Complex> multipliers_of(const OrbitEquations& equations, const OrbitEvaluation& at) {
    const VectorXd ones = VectorXd::Ones(index(equations.layout().start_of(at.pieces.size())));
    return CyclicMatrix(at.system, 1, ones, ones).multipliers();
}

std::optional<Complex> pair_on_circle(const std::vector<Complex>& multipliers) {
    std::optional<Complex> nearest;
    const auto distance = [](Complex one) { return std::abs(std::log(std::abs(one))); };
    for (const Complex one : multipliers)
        if (one.imag() > 0 && (!nearest || distance(one) < distance(*nearest)))
            nearest = one;
    return nearest;
}

} // namespace graze
