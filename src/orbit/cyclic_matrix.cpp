#include "orbit/cyclic_matrix.hpp"

#include "orbit/eigen_index.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace graze {

namespace {

using Solver = Eigen::GeneralizedEigenSolver<Eigen::MatrixXd>;

/// Eigenvalues of the relation between the first start and the one after the last segment. Those that are infinite, as
/// where a contact has no speed, are left out. @return none where that fails
std::optional<Solver> solved(const CyclicSystem& system,
                             std::vector<std::pair<std::complex<double>, Eigen::Index>>& all) {
    const auto [first, last] = system.relation();
    Solver solver(first, -last);
    if (solver.info() != Eigen::Success)
        return std::nullopt;
    for (Eigen::Index i = 0; i < solver.betas().size(); ++i) {
        const std::complex<double> one = solver.alphas()[i] / solver.betas()[i];
        if (solver.betas()[i] != 0 && std::isfinite(std::abs(one)))
            all.emplace_back(one, i);
    }
    return solver;
}

/// The vector of the multiplier nearest to a number.
bool vector_near(const CyclicSystem& system, std::complex<double> wanted, std::complex<double>& value,
                 Eigen::VectorXcd& vector) {
    std::vector<std::pair<std::complex<double>, Eigen::Index>> all;
    const auto solver = solved(system, all);
    if (!solver || all.empty())
        return false;
    // By size and angle: those that are zero are near to nothing.
    const auto distance = [&](std::complex<double> one) { return std::abs(std::log(one / wanted)); };
    const auto nearest = std::min_element(
        all.begin(), all.end(), [&](const auto& a, const auto& b) { return distance(a.first) < distance(b.first); });
    value = nearest->first;
    const Eigen::VectorXcd start = solver->eigenvectors().col(nearest->second), end = value * start;
    const Eigen::VectorXd real = system.between(start.real(), end.real()),
                          imaginary = system.between(start.imag(), end.imag());
    vector = real.cast<std::complex<double>>() + std::complex<double>(0, 1) * imaginary;
    return vector.allFinite() && vector.norm() > 0;
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

/// Its unknowns are left vectors in reverse order, for each block the weights of the closing rows first.
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
    std::vector<std::pair<std::complex<double>, Eigen::Index>> all;
    if (system.factor())
        solved(system, all);
    std::vector<std::complex<double>> result;
    for (const auto& one : all)
        result.push_back(one.first);
    return result;
}

bool CyclicMatrix::multiplier_near(std::complex<double> wanted, Multiplier& result) const {
    CyclicSystem system = direct({}), other = transposed({});
    std::complex<double> again;
    Eigen::VectorXcd backwards;
    if (!system.factor() || !other.factor() || !vector_near(system, wanted, result.value, result.right) ||
        !vector_near(other, result.value, again, backwards))
        return false;
    result.left.resize(backwards.size());
    result.left.real() = restored(backwards.real());
    result.left.imag() = restored(backwards.imag());
    // A(mu) = A_0 + mu N, where N closes: what the left vector makes of N times the right one is to be one.
    const Eigen::VectorXcd closing = next_.back().cast<std::complex<double>>() * result.right.head(n_);
    const std::complex<double> product = result.left.tail(n_ + 1).transpose() * closing;
    constexpr double least_angle = 1e-10; // of left and right vector: a multiplier with less is not simple
    if (!(std::abs(product) > least_angle * result.left.norm() * result.right.norm()))
        return false;
    result.left /= product;
    return result.left.allFinite();
}

} // namespace graze
