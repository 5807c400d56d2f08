#include "orbit/cyclic_matrix.hpp"

#include "base/decompositions.hpp"
#include "base/linear_systems.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace graze {

namespace {

using Complex = std::complex<double>;

/// Finite multipliers mu of a relation first * x_0 + last * x_m = 0 with x_m = mu x_0.
struct CycleSpectrum {
    explicit CycleSpectrum(const CyclicSystem& system) : relation(system.relation()) {
        if (relation.first.rows() == 0)
            return;
        const auto found = generalized_eigenvalues(relation.first, -relation.second);
        for (Eigen::Index i = 0; found && i < found->denominators.size(); ++i) {
            const Complex one = found->numerators[i] / found->denominators[i];
            if (found->denominators[i] != 0 && std::isfinite(std::abs(one)))
                all.push_back(one);
        }
    }
    /// Removes and returns the multiplier nearest to `wanted`; empty when none is left.
    std::optional<Complex> take(Complex wanted) {
        const auto nearest = std::ranges::min_element(
            all, [&](Complex a, Complex b) { return std::abs(a - wanted) < std::abs(b - wanted); });
        if (nearest == all.end())
            return std::nullopt;
        const Complex result = *nearest;
        all.erase(nearest);
        return result;
    }
    /// Returns the start x_0 that belongs to a multiplier: the null vector of the relation with x_m = mu x_0.
    Eigen::VectorXcd vector_of(Complex multiplier) const {
        return null_vector(relation.first + multiplier * relation.second);
    }

    std::pair<Eigen::MatrixXd, Eigen::MatrixXd> relation;
    std::vector<Complex> all;
};

/// Returns a basis of the invariant plane of two close multipliers, by inverse subspace iteration with a shift beside
/// them.
Eigen::MatrixXd plane_of_close(const CycleSpectrum& others, double middle) {
    constexpr double share = 0.1;   // offset of the shift, as a share of the distance to the nearest other multiplier
    constexpr int repetitions = 20; // each reduces components outside the plane to about a ninth or less
    const auto& [first, last] = others.relation;
    double nearest = std::abs(middle);
    for (const Complex one : others.all)
        nearest = std::min(nearest, std::abs(one - middle));
    const PartialLU shifted(first + middle * (1 + share * nearest / std::abs(middle)) * last);
    Eigen::MatrixXd starts = Eigen::MatrixXd::NullaryExpr(first.rows(), 2, [](Eigen::Index i, Eigen::Index j) {
        return std::cos(static_cast<double>(i) * (1.7 + static_cast<double>(j)) + 0.3);
    });
    for (int repetition = 0; repetition < repetitions && starts.allFinite(); ++repetition)
        starts = orthogonal_factors(shifted.solve_columns(last * starts)).orthogonal;
    return starts;
}

/// Computes the invariant plane of two multipliers, as a basis of starts x_0, and the map of the plane to itself in one
/// period.
bool plane_of(const CyclicSystem& system, Complex one, Complex other, Eigen::MatrixXd& starts, Eigen::Matrix2d& map) {
    constexpr double close = 1e-3; // multipliers that differ by a smaller share have nearly parallel vectors
    CycleSpectrum spectrum(system);
    const auto& [first, last] = spectrum.relation;
    const auto at = spectrum.take(one), beside = spectrum.take(other);
    if (!at || !beside)
        return false;
    if (std::abs(one - other) < close * std::abs(one)) {
        starts = plane_of_close(spectrum, 0.5 * (one + other).real());
    } else {
        const Eigen::VectorXcd vector = spectrum.vector_of(*at);
        starts.resize(first.rows(), 2);
        starts.col(0) = vector.real();
        starts.col(1) =
            at->imag() != 0 ? Eigen::VectorXd(vector.imag()) : Eigen::VectorXd(spectrum.vector_of(*beside).real());
    }
    if (!starts.allFinite())
        return false;
    map = -PivotedQR(last * starts).solve_columns(first * starts);
    return map.allFinite();
}

/// Returns all unknowns along the cycle, between these starts and their images.
Eigen::MatrixXd between(const CyclicSystem& system, const Eigen::MatrixXd& starts, const Eigen::Matrix2d& map) {
    const Eigen::MatrixXd ends = starts * map;
    Eigen::MatrixXd result(system.unknowns(), 2);
    for (Eigen::Index i = 0; i < 2; ++i)
        result.col(i) = system.between(starts.col(i), ends.col(i));
    return result;
}

} // namespace

CyclicMatrix::CyclicMatrix(const CyclicSystem& system, double factor, const Eigen::VectorXd& rows,
                           const Eigen::VectorXd& columns)
    : n_(system.block(0).next.cols()), count_(index(system.segments())) {
    for (Eigen::Index k = 0; k < count_; ++k) {
        const CyclicSystem::Block& block = system.block(static_cast<std::size_t>(k));
        const Eigen::VectorXd factors = rows.segment(k * (n_ + 1), n_ + 1);
        const Eigen::Index following = (k + 1) % count_ * (n_ + 1);
        own_.emplace_back(factors.asDiagonal() * block.own * columns.segment(k * (n_ + 1), n_ + 1).asDiagonal());
        next_.emplace_back(factors.asDiagonal() * block.next * columns.segment(following, n_).asDiagonal());
    }
    next_.back() *= factor;
}

CyclicSystem CyclicMatrix::direct(const Eigen::VectorXd& column) const {
    const Eigen::Index q = column.size() > 0 ? 1 : 0;
    CyclicSystem result(static_cast<std::size_t>(n_), static_cast<std::size_t>(q));
    result.resize(own_.size());
    for (std::size_t k = 0; k < own_.size(); ++k) {
        CyclicSystem::Block& block = result.block(k);
        block.own = own_[k];
        block.next = next_[k];
        block.right.setZero();
        if (q > 0)
            block.parameters = column.segment(index(k) * (n_ + 1), n_ + 1);
    }
    return result;
}

/// The unknowns are left vectors in reverse order; in each block the weights of the continuity rows come first.
CyclicSystem CyclicMatrix::transposed(const Eigen::VectorXd& column) const {
    const Eigen::Index q = column.size() > 0 ? 1 : 0;
    CyclicSystem result(static_cast<std::size_t>(n_), static_cast<std::size_t>(q));
    result.resize(own_.size());
    for (std::size_t j = 0; j < own_.size(); ++j) {
        const std::size_t k = own_.size() - 1 - j, before = k > 0 ? k - 1 : own_.size() - 1;
        CyclicSystem::Block& block = result.block(j);
        block.own << own_[k].bottomRows(n_).transpose(), own_[k].row(0).transpose();
        block.next.setZero();
        block.next.topRows(n_) = next_[before].bottomRows(n_).transpose();
        block.right.setZero();
        if (q > 0)
            block.parameters = column.segment(index(k) * (n_ + 1), n_ + 1);
    }
    return result;
}

Eigen::VectorXd CyclicMatrix::reversed(const Eigen::VectorXd& left) const {
    Eigen::VectorXd result(left.size());
    for (Eigen::Index j = 0; j < count_; ++j)
        result.segment(j * (n_ + 1), n_ + 1) << left.segment((count_ - 1 - j) * (n_ + 1) + 1, n_),
            left[(count_ - 1 - j) * (n_ + 1)];
    return result;
}

Eigen::VectorXd CyclicMatrix::restored(const Eigen::VectorXd& reversed) const {
    Eigen::VectorXd result(count_ * (n_ + 1));
    for (Eigen::Index j = 0; j < count_; ++j)
        result.segment((count_ - 1 - j) * (n_ + 1), n_ + 1) << reversed[j * (n_ + 1) + n_],
            reversed.segment(j * (n_ + 1), n_);
    return result;
}

bool CyclicMatrix::null_vectors(Eigen::VectorXd& right, Eigen::VectorXd& left) const {
    const Eigen::MatrixXd none(0, count_ * (n_ + 1));
    CyclicSystem system = direct({}), other = transposed({});
    Eigen::VectorXd backwards;
    if (!system.factor() || !other.factor() || !system.null_vector(none, right) || !other.null_vector(none, backwards))
        return false;
    right /= right.norm();
    left = restored(backwards / backwards.norm());
    return right.allFinite() && left.allFinite();
}

bool CyclicMatrix::bordered(const Eigen::VectorXd& b, const Eigen::VectorXd& c, Eigen::VectorXd& right,
                            Eigen::VectorXd& left, double& value) const {
    CyclicSystem system = direct(b), other = transposed(c);
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
    const auto solve = [&](CyclicSystem& with, const Eigen::VectorXd& row, Eigen::VectorXd& solution) {
        Eigen::MatrixXd all = Eigen::MatrixXd::Zero(1, row.size() + 1);
        all.leftCols(row.size()) = row.transpose();
        return with.factor() && with.solve(with.close(all), nullptr, one, solution);
    };
    Eigen::VectorXd backwards;
    if (!solve(system, c, right) || !solve(other, reversed(b), backwards))
        return false;
    value = right[right.size() - 1];
    right.conservativeResize(right.size() - 1);
    left = restored(backwards.head(backwards.size() - 1));
    return true;
}

double CyclicMatrix::closing_product(const Eigen::VectorXd& left, const Eigen::VectorXd& right) const {
    return left.tail(n_ + 1).dot(next_.back() * right.head(n_));
}

std::vector<std::complex<double>> CyclicMatrix::multipliers() const {
    CyclicSystem system = direct({});
    return system.factor() ? CycleSpectrum(system).all : std::vector<std::complex<double>>();
}

bool CyclicMatrix::plane_near(std::complex<double> one, std::complex<double> other, Plane& result) const {
    CyclicSystem system = direct({}), backwards = transposed({});
    Eigen::MatrixXd starts, left_starts;
    Eigen::Matrix2d left_map;
    if (!system.factor() || !backwards.factor() || !plane_of(system, one, other, starts, result.map) ||
        !plane_of(backwards, one, other, left_starts, left_map))
        return false;
    result.right = between(system, starts, result.map);
    const Eigen::MatrixXd left = between(backwards, left_starts, left_map);
    result.left.resize(left.rows(), 2);
    for (Eigen::Index i = 0; i < 2; ++i)
        result.left.col(i) = restored(left.col(i));
    // A(mu) = A_0 + mu N, where N is the closing block. Normalise: left^T N right is the identity.
    const Eigen::Matrix2d product =
        result.left.bottomRows(n_ + 1).transpose() * (next_.back() * result.right.topRows(n_));
    // Of the product of angles between left and right plane: below it, other multipliers are as near.
    constexpr double least = 1e-20;
    const double sizes = result.left.colwise().norm().prod() * result.right.colwise().norm().prod();
    if (!(std::abs(product.determinant()) > least * sizes))
        return false;
    result.left *= product.inverse().transpose();
    return result.right.allFinite() && result.left.allFinite();
}

} // namespace graze
