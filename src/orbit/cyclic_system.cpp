#include "orbit/cyclic_system.hpp"
#include "orbit/eigen_index.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace graze {

namespace {

/// Makes the first columns of [a | b] upper triangular by reflections. @return the sign of their determinant
double reflect(Eigen::MatrixXd& a, Eigen::MatrixXd& b) {
    double sign = 1;
    for (Eigen::Index c = 0; c < a.cols() && c + 1 < a.rows(); ++c) {
        const Eigen::Index rows = a.rows() - c;
        auto column = a.col(c).tail(rows);
        const double below = column.tail(rows - 1).squaredNorm();
        if (below == 0)
            continue;
        const double norm = std::sqrt(below + column[0] * column[0]);
        const double alpha = column[0] > 0 ? -norm : norm;
        Eigen::VectorXd v = column;
        v[0] -= alpha;
        const double factor = 2 / v.squaredNorm();
        const auto apply = [&](auto&& block) { block.noalias() -= v * (factor * (v.transpose() * block)).eval(); };
        apply(a.bottomRightCorner(rows, a.cols() - c));
        apply(b.bottomRows(rows));
        column.tail(rows - 1).setZero();
        sign = -sign;
    }
    return sign;
}

} // namespace

CyclicSystem::CyclicSystem(std::size_t states, std::size_t parameters) : n_(states), q_(parameters) {
    stack_.resize(index(2 * n_ + 1), index(n_ + 1));
    right_.resize(index(2 * n_ + 1), index(2 * n_ + q_ + 1));
    final_.resize(index(n_), index(2 * n_ + q_ + 1));
}

void CyclicSystem::resize(std::size_t segments) {
    count_ = segments;
    for (std::size_t k = blocks_.size(); k < segments; ++k)
        blocks_.push_back({Eigen::MatrixXd::Zero(index(n_ + 1), index(n_ + 1)),
                           Eigen::MatrixXd::Zero(index(n_ + 1), index(n_)),
                           Eigen::MatrixXd::Zero(index(n_ + 1), index(q_)), Eigen::VectorXd::Zero(index(n_ + 1))});
    for (std::size_t k = eliminated_.size(); k < segments; ++k)
        eliminated_.push_back(
            {Eigen::MatrixXd(index(n_ + 1), index(n_ + 1)), Eigen::MatrixXd(index(n_ + 1), index(2 * n_ + q_ + 1))});
}

bool CyclicSystem::factor() {
    const Eigen::Index n = index(n_), q = index(q_);
    // A copy of x_0, to which all others are related: C x_0 + D x_k + E p = r, at first x_0 - x_0 = 0.
    Eigen::MatrixXd relation = Eigen::MatrixXd::Zero(n, 2 * n + q + 1); // C, D, E, r
    relation.leftCols(n).setIdentity();
    relation.middleCols(n, n) = -Eigen::MatrixXd::Identity(n, n);
    sign_ = 1;
    for (std::size_t k = 0; k < count_; ++k) {
        const Block& block = blocks_[k];
        stack_.setZero();
        stack_.topLeftCorner(n, n) = relation.middleCols(n, n);
        stack_.bottomRows(n + 1) = block.own;
        right_.setZero();
        right_.topLeftCorner(n, n) = relation.leftCols(n);
        right_.topRightCorner(n, q + 1) = relation.rightCols(q + 1);
        right_.block(n, n, n + 1, n) = block.next;
        right_.block(n, 2 * n, n + 1, q) = block.parameters;
        right_.bottomRightCorner(n + 1, 1) = block.right;
        if (!stack_.allFinite() || !right_.allFinite())
            return false;
        sign_ *= reflect(stack_, right_);
        for (Eigen::Index i = 0; i <= n; ++i)
            sign_ *= stack_(i, i) < 0 ? -1 : 1;
        eliminated_[k].triangle = stack_.topRows(n + 1);
        eliminated_[k].rest = right_.topRows(n + 1);
        relation = right_.bottomRows(n);
    }
    final_ = relation;
    return true;
}

double CyclicSystem::periodic_determinant() const {
    const Eigen::Index n = index(n_);
    return sign_ * (final_.leftCols(n) + final_.middleCols(n, n)).determinant();
}

double CyclicSystem::antiperiodic_determinant() const {
    const Eigen::Index n = index(n_);
    return sign_ * (final_.leftCols(n) - final_.middleCols(n, n)).determinant();
}

double CyclicSystem::periodic_noise() const {
    constexpr double round_off = 1e-9; // of derivatives, which are integrated
    const Eigen::Index n = index(n_);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(final_.leftCols(n) + final_.middleCols(n, n));
    const Eigen::VectorXd& values = svd.singularValues();
    return n == 0 ? 0 : round_off * values[0] * values.head(n - 1).prod();
}

CyclicSystem::Condensed CyclicSystem::condense(const Eigen::MatrixXd& borders, const Eigen::VectorXd& right,
                                               bool homogeneous) const {
    const Eigen::Index n = index(n_), q = index(q_);
    Condensed result{Eigen::MatrixXd(n + q, n + q), Eigen::VectorXd(n + q)};
    result.matrix.topLeftCorner(n, n) = final_.leftCols(n) + final_.middleCols(n, n);
    result.matrix.topRightCorner(n, q) = final_.middleCols(2 * n, q);
    result.values.head(n).setZero();
    if (!homogeneous)
        result.values.head(n) = final_.rightCols(1);
    // In the further equations each start is replaced in its turn by x_0, the next start and p.
    Eigen::MatrixXd rows = borders;
    Eigen::MatrixXd start = Eigen::MatrixXd::Zero(q, n); // coefficients of the copy of x_0
    Eigen::VectorXd constants = right;
    for (std::size_t k = 0; k < count_; ++k) {
        const Eliminated& gone = eliminated_[k];
        const Eigen::MatrixXd own = rows.middleCols(index(k) * (n + 1), n + 1);
        if (own.isZero(0))
            continue;
        // own (x_k, T_k) = own R^-1 (s - rest)
        const Eigen::MatrixXd factor =
            gone.triangle.triangularView<Eigen::Upper>().transpose().solve(own.transpose()).transpose();
        const Eigen::MatrixXd change = factor * gone.rest;
        start -= change.leftCols(n);
        if (k + 1 < count_)
            rows.middleCols(index(k + 1) * (n + 1), n) -= change.middleCols(n, n);
        else
            start -= change.middleCols(n, n);
        rows.rightCols(q) -= change.middleCols(2 * n, q);
        if (!homogeneous)
            constants -= change.rightCols(1);
    }
    result.matrix.bottomLeftCorner(q, n) = start;
    result.matrix.bottomRightCorner(q, q) = rows.rightCols(q);
    result.values.tail(q) = constants;
    return result;
}

/// All unknowns, from the first start and the parameters, and the start after the last segment.
Eigen::VectorXd CyclicSystem::expand(const Eigen::VectorXd& first, const Eigen::VectorXd& last,
                                     bool homogeneous) const {
    const Eigen::Index n = index(n_), q = index(q_);
    Eigen::VectorXd solution(index(unknowns()));
    solution.tail(q) = first.tail(q);
    Eigen::VectorXd following = last; // x_{k+1}, going backwards
    for (std::size_t k = count_; k-- > 0;) {
        const Eliminated& gone = eliminated_[k];
        Eigen::VectorXd sum = homogeneous ? Eigen::VectorXd::Zero(n + 1) : Eigen::VectorXd(gone.rest.rightCols(1));
        sum -= gone.rest.leftCols(n) * first.head(n) + gone.rest.middleCols(n, n) * following +
               gone.rest.middleCols(2 * n, q) * first.tail(q);
        gone.triangle.triangularView<Eigen::Upper>().solveInPlace(sum);
        solution.segment(index(k) * (n + 1), n + 1) = sum;
        following = sum.head(n);
    }
    return solution;
}

bool CyclicSystem::solve(const Eigen::MatrixXd& borders, const Eigen::VectorXd& right, bool homogeneous,
                         Eigen::VectorXd& solution, double* determinant) const {
    const Condensed condensed = condense(borders, right, homogeneous);
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(condensed.matrix);
    if (determinant)
        *determinant = sign_ * lu.determinant();
    if (!condensed.matrix.allFinite() || !lu.isInvertible())
        return false;
    const Eigen::VectorXd first = lu.solve(condensed.values);
    solution = expand(first, first.head(index(n_)), homogeneous);
    return solution.allFinite();
}

bool CyclicSystem::null_vector(const Eigen::MatrixXd& borders, Eigen::VectorXd& vector) const {
    const Condensed condensed = condense(borders, Eigen::VectorXd::Zero(index(q_)), true);
    if (!condensed.matrix.allFinite())
        return false;
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(condensed.matrix, Eigen::ComputeFullV);
    const Eigen::VectorXd first = svd.matrixV().rightCols(1);
    vector = expand(first, first.head(index(n_)), true);
    return vector.allFinite();
}

std::pair<Eigen::MatrixXd, Eigen::MatrixXd> CyclicSystem::relation() const {
    const Eigen::Index n = index(n_);
    return {final_.leftCols(n), final_.middleCols(n, n)};
}

Eigen::VectorXd CyclicSystem::between(const Eigen::VectorXd& first, const Eigen::VectorXd& last) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(index(n_ + q_));
    all.head(index(n_)) = first;
    return expand(all, last, true).head(index(count_ * (n_ + 1)));
}

} // namespace graze
