#include "design/multipliers.hpp"

#include "base/linear_systems.hpp"
#include "orbit/eigen_index.hpp"

#include <algorithm>
#include <vector>

namespace graze {

namespace {

/// Solves the nonnegative least-squares problem |A x - b| (C. L. Lawson and R. J. Hanson, "Solving Least Squares
/// Problems", 1974, chapter 23), slightly damped so that equal columns share a multiplier.
Eigen::VectorXd nonnegative(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
    constexpr double damping = 1e-5, negligible = 1e-12;
    const Eigen::Index n = a.cols();
    Eigen::VectorXd norms = a.colwise().norm().transpose();
    norms = (norms.array() > 0).select(norms, 1);
    Eigen::MatrixXd damped(a.rows() + n, n);
    damped << a * norms.cwiseInverse().asDiagonal(), damping * Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(a.rows() + n);
    right.head(a.rows()) = b;
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    std::vector<Eigen::Index> used;
    for (Eigen::Index turn = 0; turn < 10 * n; ++turn) {
        Eigen::VectorXd wish = damped.transpose() * (right - damped * x);
        for (const Eigen::Index i : used)
            wish[i] = -1;
        Eigen::Index best = 0;
        if (!(wish.maxCoeff(&best) > negligible))
            break;
        used.push_back(best);
        while (!used.empty()) {
            const Eigen::VectorXd solved = PivotedQR(damped(Eigen::all, used)).solve(right);
            double part = 1;
            for (std::size_t k = 0; k < used.size(); ++k)
                if (solved[index(k)] <= 0)
                    part = std::min(part, x[used[k]] / (x[used[k]] - solved[index(k)]));
            for (std::size_t k = 0; k < used.size(); ++k)
                x[used[k]] += part * (solved[index(k)] - x[used[k]]);
            if (part == 1)
                break;
            std::erase_if(used, [&](Eigen::Index i) {
                if (x[i] > negligible)
                    return false;
                x[i] = 0;
                return true;
            });
        }
    }
    if (used.empty())
        return x;
    // Solve again without damping, for the columns in use.
    const Eigen::MatrixXd needed = damped.topRows(a.rows())(Eigen::all, used);
    const Eigen::VectorXd exact = shortest_solution(needed, b);
    if (exact.minCoeff() >= 0)
        for (std::size_t k = 0; k < used.size(); ++k)
            x[used[k]] = exact[index(k)];
    return x.cwiseQuotient(norms);
}

/// Active limits and ends of ranges, with one column of gradients for each.
struct ActiveLimits {
    std::vector<std::size_t> rows;
    std::vector<Eigen::Index> low, high;

    ActiveLimits(const ScaledWishes& wishes, const Candidate& at, double reached_by_free) {
        for (std::size_t k = 0; k < wishes.rows().size(); ++k) {
            const double reached = wishes.rows()[k].cap.value_or(reached_by_free);
            if (wishes.violation(wishes.rows()[k], at.at) >= reached - limit_distance * std::max(1.0, reached))
                rows.push_back(k);
        }
        for (Eigen::Index i = 0; i < wishes.size(); ++i) {
            if (at.z[i] <= wishes.lowest()[i] + limit_distance)
                low.push_back(i);
            if (at.z[i] >= wishes.highest()[i] - limit_distance)
                high.push_back(i);
        }
    }

    /// @param sum whether the last row sums the multipliers of limits without a cap
    Eigen::MatrixXd columns(const ScaledWishes& wishes, const Candidate& at, bool sum) const {
        const Eigen::Index n = wishes.size();
        Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 1, index(rows.size() + low.size() + high.size()));
        Eigen::Index column = 0;
        for (const std::size_t k : rows) {
            const LimitRow& row = wishes.rows()[k];
            a.col(column).head(n) = row.sign * at.at.gradient.row(index(row.want)).transpose();
            a(n, column++) = sum && !row.cap ? 1 : 0;
        }
        for (const Eigen::Index i : low)
            a(i, column++) = -1;
        for (const Eigen::Index i : high)
            a(i, column++) = 1;
        return a;
    }
};

} // namespace

Multipliers multipliers_at(const ScaledWishes& wishes, const Candidate& at, const Eigen::VectorXd& pull,
                           bool gives_way) {
    constexpr double no_weight = 1e-6; // of a limit that is reached only by chance
    const Eigen::Index n = wishes.size();
    const double reached = gives_way ? at.violation : 0;
    const ActiveLimits active(wishes, at, reached);
    const Eigen::MatrixXd a = active.columns(wishes, at, gives_way);
    Eigen::VectorXd b(n + 1);
    b << -pull, gives_way ? 1 : 0;
    const Eigen::VectorXd x = nonnegative(a, b);

    Multipliers result{Eigen::VectorXd::Zero(index(wishes.rows().size())), Eigen::VectorXd::Zero(n),
                       Eigen::VectorXd::Zero(n), (a * x - b).norm(), 0};
    Eigen::Index column = 0;
    for (const std::size_t k : active.rows) {
        const double weight = x[column++];
        result.rows[index(k)] = weight;
        const LimitRow& row = wishes.rows()[k];
        if (weight > no_weight)
            result.gap = std::max(result.gap, row.cap.value_or(reached) - wishes.violation(row, at.at));
    }
    for (const Eigen::Index i : active.low) {
        result.lowest[i] = x[column++];
        result.gap = std::max(result.gap, result.lowest[i] * (at.z[i] - wishes.lowest()[i]));
    }
    for (const Eigen::Index i : active.high) {
        result.highest[i] = x[column++];
        result.gap = std::max(result.gap, result.highest[i] * (wishes.highest()[i] - at.z[i]));
    }
    return result;
}

Multipliers multipliers_of_violation(const ScaledWishes& wishes, const Candidate& at) {
    return multipliers_at(wishes, at, Eigen::VectorXd::Zero(wishes.size()), true);
}

Multipliers multipliers_of_distance(const ScaledWishes& wishes, const Candidate& at) {
    const double distance = at.z.norm();
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(wishes.size());
    return multipliers_at(wishes, at, distance > limit_distance ? (at.z / distance).eval() : none, false);
}

bool is_best(const ScaledWishes& wishes, const Candidate& at, double share) {
    constexpr double balanced = 1e-8, closed = 1e-11;
    const bool violated = at.violation > closed;
    const Multipliers multipliers = multipliers_at(wishes, at, share * at.z, violated);
    double sum = 0; // the elastic variable is at its own lower bound, which takes the rest of one
    for (std::size_t k = 0; k < wishes.rows().size(); ++k)
        if (!wishes.rows()[k].cap)
            sum += multipliers.rows[index(k)];
    return multipliers.residual <= balanced * std::max(share, balanced) && multipliers.gap <= closed &&
           (violated || sum <= 1);
}

} // namespace graze
