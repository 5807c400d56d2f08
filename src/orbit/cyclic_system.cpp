#include "orbit/cyclic_system.hpp"

#include "base/decompositions.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Singular values below this share of the largest one count as zero: they are errors of rounding and integration.
constexpr double rank_tolerance = 1e-8;

/// Makes the first columns of [a | b] upper triangular by Householder reflections x - m (m^T x), |m| = sqrt(2). @return
/// the sign of their determinant
double reflect(Eigen::MatrixXd& a, Eigen::MatrixXd& b, Eigen::MatrixXd& mirrors) {
    double sign = 1;
    mirrors.setZero();
    for (Eigen::Index c = 0; c < a.cols() && c + 1 < a.rows(); ++c) {
        const Eigen::Index rows = a.rows() - c;
        auto column = a.col(c).tail(rows);
        const double below = column.tail(rows - 1).squaredNorm();
        if (below == 0)
            continue;
        const double norm = std::sqrt(below + column[0] * column[0]);
        const double alpha = column[0] > 0 ? -norm : norm;
        auto mirror = mirrors.col(c).tail(rows);
        mirror = column;
        mirror[0] -= alpha;
        mirror *= std::sqrt(2 / mirror.squaredNorm());
        const auto apply = [&](auto&& block) { block.noalias() -= mirror * (mirror.transpose() * block).eval(); };
        apply(a.bottomRightCorner(rows, a.cols() - c));
        apply(b.bottomRows(rows));
        column.tail(rows - 1).setZero();
        sign = -sign;
    }
    return sign;
}

/// The same in blocks, for many columns, which is many times faster.
double reflect_in_blocks(Eigen::MatrixXd& a, Eigen::MatrixXd& b, Eigen::MatrixXd& mirrors) {
    mirrors = make_triangular_with(a, b);
    return (mirrors.colwise().squaredNorm().array() > 0).count() % 2 == 0 ? 1 : -1;
}

/// Applies the same reflections to a vector.
void apply_reflections(Eigen::VectorXd& vector, const Eigen::MatrixXd& mirrors) {
    for (Eigen::Index c = 0; c < mirrors.cols(); ++c) {
        const Eigen::Index rows = vector.size() - c;
        const auto mirror = mirrors.col(c).tail(rows);
        vector.tail(rows) -= mirror * mirror.dot(vector.tail(rows));
    }
}

/// The largest singular value of a regular matrix, and the inverse of the smallest: by power iterations, which
/// underestimate both a little.
struct Extremes {
    Extremes(const Eigen::MatrixXd& matrix, const PartialLU& factors) {
        constexpr int iterations = 4;
        const auto begin = Eigen::VectorXd::NullaryExpr(
            matrix.cols(), [](Eigen::Index i) { return std::cos(1.7 * static_cast<double>(i) + 0.3); });
        Eigen::VectorXd large = begin.normalized(), small = large;
        for (int i = 0; i < iterations; ++i) {
            large = matrix.transpose() * (matrix * large);
            largest = std::sqrt(large.norm());
            large.normalize();
            small = factors.solve(factors.solve_transposed(small));
            inverse = std::sqrt(small.norm());
            small.normalize();
        }
    }
    double largest = 0, inverse = 0;
};

/// Returns the largest singular value of a regular matrix times the product of all but the smallest one: how much the
/// determinant changes with a change of the matrix of its own size. Where the matrix is singular, by its singular
/// values.
double largest_minor(const Eigen::MatrixXd& matrix, const PartialLU& factors, double determinant) {
    const auto [largest, inverse] = Extremes(matrix, factors);
    const double result = largest * std::abs(determinant) * inverse;
    if (determinant != 0 && std::isfinite(result))
        return result;
    const Eigen::VectorXd values = singular_values(matrix, SingularVectors::none).values;
    return values[0] * values.head(values.size() - 1).prod();
}

} // namespace

CyclicSystem::CyclicSystem(std::size_t states, std::size_t parameters) : n_(states), q_(parameters) {
    final_.resize(index(n_), index(2 * n_ + q_));
}

bool CyclicSystem::keeps_first_start() const {
    return index(n_) > many_states;
}

void CyclicSystem::resize(std::size_t segments) {
    count_ = segments;
    for (std::size_t k = blocks_.size(); k < segments; ++k)
        blocks_.push_back({Eigen::MatrixXd::Zero(index(n_ + 1), index(n_ + 1)),
                           Eigen::MatrixXd::Zero(index(n_ + 1), index(n_)),
                           Eigen::MatrixXd::Zero(index(n_ + 1), index(q_)), Eigen::VectorXd::Zero(index(n_ + 1))});
    for (std::size_t k = eliminated_.size(); k < segments; ++k) {
        const Eigen::Index gone = k == 0 && keeps_first_start() ? 1 : index(n_ + 1), rows = gone + index(n_);
        eliminated_.push_back(
            {Eigen::MatrixXd(gone, gone), Eigen::MatrixXd(gone, index(2 * n_ + q_)), Eigen::MatrixXd(rows, gone)});
    }
}

/// Eliminates the duration of the first segment by one reflection. @return false when a number is not finite
bool CyclicSystem::eliminate_first_duration() {
    const Eigen::Index n = index(n_);
    const Block& block = blocks_.front();
    Eliminated& gone = eliminated_.front();
    Eigen::MatrixXd duration = block.own.rightCols(1), others(n + 1, 2 * n + index(q_));
    others << block.own.leftCols(n), block.next, block.parameters;
    if (!duration.allFinite() || !others.allFinite())
        return false;
    sign_ *= reflect(duration, others, gone.mirrors) * (duration(0, 0) < 0 ? -1 : 1);
    gone.triangle = duration.topRows(1);
    gone.rest = others.topRows(1);
    final_ = others.bottomRows(n);
    return true;
}

bool CyclicSystem::factor() {
    const Eigen::Index n = index(n_), q = index(q_);
    // Relates each x_k to x_0: C x_0 + D x_k + E p is known. Initially x_0 - x_0 = 0.
    Eigen::MatrixXd relation; // C, D, E
    sign_ = 1;
    std::size_t begin = 0;
    if (keeps_first_start()) {
        if (!eliminate_first_duration())
            return false;
        if (++begin == count_)
            return true;
        relation = final_;
    } else {
        relation.setZero(n, 2 * n + q);
        relation.leftCols(n).setIdentity();
        relation.middleCols(n, n) = -Eigen::MatrixXd::Identity(n, n);
    }
    stack_.resize(2 * n + 1, n + 1);
    right_.resize(2 * n + 1, 2 * n + q);
    for (std::size_t k = begin; k < count_; ++k) {
        const Block& block = blocks_[k];
        stack_.setZero();
        stack_.topLeftCorner(n, n) = relation.middleCols(n, n);
        stack_.bottomRows(n + 1) = block.own;
        right_.setZero();
        right_.topLeftCorner(n, n) = relation.leftCols(n);
        right_.topRightCorner(n, q) = relation.rightCols(q);
        right_.block(n, n, n + 1, n) = block.next;
        right_.block(n, 2 * n, n + 1, q) = block.parameters;
        if (!stack_.allFinite() || !right_.allFinite())
            return false;
        sign_ *= (n > many_states ? reflect_in_blocks : reflect)(stack_, right_, eliminated_[k].mirrors);
        for (Eigen::Index i = 0; i <= n; ++i)
            sign_ *= stack_(i, i) < 0 ? -1 : 1;
        eliminated_[k].triangle = stack_.topRows(n + 1);
        eliminated_[k].rest = right_.topRows(n + 1);
        relation = right_.bottomRows(n);
    }
    final_ = relation;
    return true;
}

CyclicSystem::Determinant CyclicSystem::determinant_closed_by(double closing) const {
    constexpr double round_off = 1e-9; // error of the integrated derivatives
    const Eigen::Index n = index(n_);
    if (n == 0)
        return {sign_, 0};
    const Eigen::MatrixXd matrix = final_.leftCols(n) + closing * final_.middleCols(n, n);
    const PartialLU factors(matrix);
    const double value = factors.determinant();
    return {sign_ * value, round_off * largest_minor(matrix, factors, value)};
}

/// Returns the matrix of the condensed equations, in x_0 and p alone.
Eigen::MatrixXd CyclicSystem::condense(const Eigen::MatrixXd& borders, std::vector<Eigen::MatrixXd>& shares) const {
    const Eigen::Index n = index(n_), q = index(q_);
    Eigen::MatrixXd result(n + q, n + q);
    result.topLeftCorner(n, n) = final_.leftCols(n) + final_.middleCols(n, n);
    result.topRightCorner(n, q) = final_.middleCols(2 * n, q);
    // In the border equations each start is expressed in turn by x_0, the next start and p.
    Eigen::MatrixXd rows = borders;
    Eigen::MatrixXd start = Eigen::MatrixXd::Zero(q, n); // coefficients of x_0
    shares.resize(count_);
    for (std::size_t k = 0; k < count_; ++k) {
        const Eliminated& gone = eliminated_[k];
        const bool keeps_start = k == 0 && keeps_first_start();
        Eigen::MatrixXd own = rows.middleCols(index(k) * (n + 1), n + 1);
        if (keeps_start) {
            start = own.leftCols(n);
            own = own.rightCols(1).eval();
        }
        shares[k].resize(0, 0);
        if (own.isZero(0))
            continue;
        // own (x_k, T_k) = own R^-1 (s - rest)
        shares[k] = gone.triangle.triangularView<Eigen::Upper>().transpose().solve(own.transpose()).transpose();
        const Eigen::MatrixXd change = shares[k] * gone.rest;
        start -= change.leftCols(n);
        if (k + 1 < count_)
            rows.middleCols(index(k + 1) * (n + 1), n) -= change.middleCols(n, n);
        else
            start -= change.middleCols(n, n);
        rows.rightCols(q) -= change.middleCols(2 * n, q);
    }
    result.bottomLeftCorner(q, n) = start;
    result.bottomRightCorner(q, q) = rows.rightCols(q);
    return result;
}

/// Returns all unknowns from (x_0, p) and the start after the last segment, by back substitution.
/// @param constants right-hand sides of the eliminated equations of each segment; empty: zero
Eigen::VectorXd CyclicSystem::expand(const Eigen::VectorXd& first, const Eigen::VectorXd& last,
                                     const std::vector<Eigen::VectorXd>& constants) const {
    const Eigen::Index n = index(n_), q = index(q_);
    Eigen::VectorXd solution(index(unknowns()));
    solution.tail(q) = first.tail(q);
    Eigen::VectorXd following = last; // x_{k+1}, going backwards
    for (std::size_t k = count_; k-- > 0;) {
        const Eliminated& gone = eliminated_[k];
        Eigen::VectorXd sum = constants.empty() ? Eigen::VectorXd::Zero(gone.rest.rows()) : constants[k];
        sum -= gone.rest.leftCols(n) * first.head(n) + gone.rest.middleCols(n, n) * following +
               gone.rest.middleCols(2 * n, q) * first.tail(q);
        gone.triangle.triangularView<Eigen::Upper>().solveInPlace(sum);
        if (k == 0 && keeps_first_start())
            solution.head(n + 1) << first.head(n), sum;
        else
            solution.segment(index(k) * (n + 1), n + 1) = sum;
        following = sum.head(std::min(n, sum.size()));
    }
    return solution;
}

CyclicSystem::Closed CyclicSystem::close(const Eigen::MatrixXd& borders) const {
    Closed closed;
    const Eigen::MatrixXd matrix = condense(borders, closed.shares_);
    const bool finite = matrix.allFinite();
    closed.lu_.compute(matrix);
    closed.determinant_ = sign_ * closed.lu_.determinant();
    closed.regular_ = finite && closed.lu_.is_invertible();
    return closed;
}

Eigen::VectorXd CyclicSystem::right_hand_sides() const {
    const Eigen::Index width = index(n_ + 1);
    Eigen::VectorXd result(index(count_) * width);
    for (std::size_t k = 0; k < count_; ++k)
        result.segment(index(k) * width, width) = blocks_[k].right;
    return result;
}

bool CyclicSystem::solve(const Closed& closed, const Eigen::VectorXd* blocks, const Eigen::VectorXd& right,
                         Eigen::VectorXd& solution) const {
    if (!closed.regular_)
        return false;
    const Eigen::Index n = index(n_), q = index(q_);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(n + q);
    values.tail(q) = right;
    std::vector<Eigen::VectorXd> constants;
    if (blocks)
        values.head(n) = reduced(*blocks, constants);
    for (std::size_t k = 0; k < constants.size(); ++k)
        if (closed.shares_[k].size() > 0)
            values.tail(q) -= closed.shares_[k] * constants[k];
    const Eigen::VectorXd first = closed.lu_.solve(values);
    solution = expand(first, first.head(n), constants);
    return solution.allFinite();
}

/// Returns the right-hand side of the condensed equations of x_0, and sets those of the eliminated equations.
Eigen::VectorXd CyclicSystem::reduced(const Eigen::VectorXd& blocks, std::vector<Eigen::VectorXd>& constants) const {
    const Eigen::Index n = index(n_);
    Eigen::VectorXd values = Eigen::VectorXd::Zero(n);
    for (std::size_t k = 0; k < count_; ++k) {
        const bool keeps_start = k == 0 && keeps_first_start();
        Eigen::VectorXd both(keeps_start ? n + 1 : 2 * n + 1);
        both.head(both.size() - n - 1) = values.head(both.size() - n - 1);
        both.tail(n + 1) = blocks.segment(index(k) * (n + 1), n + 1);
        apply_reflections(both, eliminated_[k].mirrors);
        constants.emplace_back(both.head(both.size() - n));
        values = both.tail(n);
    }
    return values;
}

bool CyclicSystem::solve_nearest(const Eigen::VectorXd& blocks, Eigen::VectorXd& solution,
                                 std::size_t& deficiency) const {
    const Eigen::Index n = index(n_);
    std::vector<Eigen::VectorXd> constants;
    const Eigen::VectorXd values = reduced(blocks, constants);
    const SingularValues factors =
        singular_values(Eigen::MatrixXd(final_.leftCols(n) + final_.middleCols(n, n)), SingularVectors::full);
    const Eigen::Index kept = std::min(factors.rank(rank_tolerance), n - index(deficiency));
    deficiency = static_cast<std::size_t>(n - kept);
    const Eigen::VectorXd first =
        factors.right.leftCols(kept) *
        (factors.left.leftCols(kept).transpose() * values).cwiseQuotient(factors.values.head(kept));
    solution = expand(first, first, constants);
    return solution.allFinite();
}

std::size_t CyclicSystem::undetermined() const {
    const Eigen::Index n = index(n_);
    Eigen::MatrixXd matrix(n, n + index(q_));
    matrix << final_.leftCols(n) + final_.middleCols(n, n), final_.rightCols(index(q_));
    // Singular values of large matrices take long: most matrices are regular by far, parameters apart.
    if (n > many_states && matrix.allFinite()) {
        constexpr double far = 100; // the extremes are estimates
        const Eigen::MatrixXd square = matrix.leftCols(n);
        const auto [largest, inverse] = Extremes(square, PartialLU(square));
        if (largest * inverse * far * rank_tolerance < 1)
            return 0;
    }
    return static_cast<std::size_t>(n - singular_values(matrix, SingularVectors::none).rank(rank_tolerance));
}

bool CyclicSystem::null_vector(const Eigen::MatrixXd& borders, Eigen::VectorXd& vector) const {
    std::vector<Eigen::MatrixXd> shares;
    const Eigen::MatrixXd matrix = condense(borders, shares);
    if (!matrix.allFinite())
        return false;
    const Eigen::VectorXd first = singular_values(matrix, SingularVectors::right).right.rightCols(1);
    vector = expand(first, first.head(index(n_)), {});
    return vector.allFinite();
}

std::pair<Eigen::MatrixXd, Eigen::MatrixXd> CyclicSystem::relation() const {
    const Eigen::Index n = index(n_);
    return {final_.leftCols(n), final_.middleCols(n, n)};
}

Eigen::VectorXd CyclicSystem::between(const Eigen::VectorXd& first, const Eigen::VectorXd& last) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(index(n_ + q_));
    all.head(index(n_)) = first;
    return expand(all, last, {}).head(index(count_ * (n_ + 1)));
}

} // namespace graze
