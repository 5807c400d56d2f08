#include "design/wish_programme.hpp"

#include "base/linear_systems.hpp"

#include <nlopt.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <utility>
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

constexpr double stationary = 1e-7; ///< residual of gradients at a stationary point
/// Weights of the distance relative to violations, tried in turn until all requirements are met.
constexpr std::array<double, 5> distance_shares{1, 1e-2, 1e-4, 1e-6, 1e-8};
constexpr double least_region = 1e-10; ///< smallest region next to designs without values, in scales
constexpr double no_gain = 1e-12;      ///< smaller relative gains of the objective are ignored
constexpr double beside_face = 1e-7;   ///< relative to a region's size: its face counts as reached

/// One run of sequential quadratic programming on the design and the elastic variable, which is the last unknown,
/// scaled by 1/share so that second derivatives of the objective are 1.
class Programme {
public:
    Programme(ScaledWishes& wishes, double share) : wishes_(wishes), share_(share) {}

    /// Returns the best design that was evaluated, whatever the method's own result.
    Candidate run(const Candidate& from, const Eigen::VectorXd& lowest, const Eigen::VectorXd& highest) {
        const Eigen::Index n = wishes_.size();
        best_ = from;
        seen_missing_.reset();
        idle_ = 0;
        is_best_ = false;
        optimiser_.reset(nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(n + 1)));
        if (!optimiser_)
            throw std::bad_alloc();
        Eigen::VectorXd unknowns(n + 1), low(n + 1), high(n + 1);
        unknowns << from.z.cwiseMax(lowest).cwiseMin(highest), from.violation / share_;
        low << lowest, 0;
        high << highest, std::numeric_limits<double>::infinity();
        constexpr double smallest_step = 1e-13; // in scales
        nlopt_set_lower_bounds(optimiser_.get(), low.data());
        nlopt_set_upper_bounds(optimiser_.get(), high.data());
        nlopt_set_xtol_abs1(optimiser_.get(), smallest_step);
        nlopt_set_maxeval(optimiser_.get(), most_iterations);
        nlopt_set_min_objective(optimiser_.get(), objective, this);
        const std::vector<double> exactly(wishes_.rows().size(), 0);
        nlopt_add_inequality_mconstraint(optimiser_.get(), static_cast<unsigned>(exactly.size()), limits, this,
                                         exactly.data());
        double least = 0;
        nlopt_optimize(optimiser_.get(), unknowns.data(), &least);
        if (wishes_.thrown)
            std::rethrow_exception(wishes_.thrown);
        return best_;
    }
    /// The design without values that stopped it, if one did.
    const std::optional<Eigen::VectorXd>& missing() const { return seen_missing_; }
    bool is_best() const { return is_best_; }

private:
    static constexpr int most_iterations = 300;
    static constexpr Eigen::Index most_idle = 15;

    static double objective(unsigned count, const double* unknowns, double* gradient, void* /*programme*/) {
        const Eigen::Index n = static_cast<Eigen::Index>(count) - 1;
        const Eigen::Map<const Eigen::VectorXd> z(unknowns, n);
        if (gradient) {
            Eigen::Map<Eigen::VectorXd>(gradient, n) = z;
            gradient[n] = 1;
        }
        return unknowns[n] + z.squaredNorm() / 2;
    }

    static void limits(unsigned count, double* result, unsigned unknown_count, const double* unknowns, double* gradient,
                       void* self) {
        auto& programme = *static_cast<Programme*>(self);
        try { // exceptions must not pass through the C library
            programme.set_limits(index(count), result, static_cast<Eigen::Index>(unknown_count), unknowns, gradient);
        } catch (...) {
            programme.wishes_.thrown = std::current_exception();
            programme.wishes_.stop_reason = StopReason::exception;
            programme.stop(index(count), result, gradient, static_cast<Eigen::Index>(unknown_count));
        }
    }

    void set_limits(Eigen::Index count, double* result, Eigen::Index unknown_count, const double* unknowns,
                    double* gradient) {
        const Eigen::Index n = unknown_count - 1;
        const Eigen::VectorXd z = Eigen::Map<const Eigen::VectorXd>(unknowns, n);
        const Evaluation& at = wishes_.evaluate(z);
        if (!at.exists) {
            if (wishes_.stop_reason == StopReason::none)
                seen_missing_ = z;
            return stop(count, result, gradient, unknown_count);
        }
        const std::vector<LimitRow>& rows = wishes_.rows();
        for (std::size_t k = 0; k < rows.size(); ++k) {
            result[k] = wishes_.violation(rows[k], at) - rows[k].cap.value_or(share_ * unknowns[n]);
            if (!gradient)
                continue;
            Eigen::Map<Eigen::VectorXd> row(gradient + index(k) * unknown_count, unknown_count);
            row.head(n) = rows[k].sign * at.gradient.row(index(rows[k].want)).transpose();
            row[n] = rows[k].cap ? 0 : -share_;
        }
        Candidate here{z, at, wishes_.largest(at)};
        ++idle_;
        if (wishes_.keeps_caps(at) && here.merit(share_) < best_.merit(share_)) {
            if (best_.merit(share_) - here.merit(share_) > no_gain * (1 + best_.merit(share_)))
                idle_ = 0;
            best_ = std::move(here);
            is_best_ = graze::is_best(wishes_, best_, share_);
        }
        if (is_best_ || idle_ > most_idle + 2 * n) // otherwise round-off and noise would keep it moving
            nlopt_force_stop(optimiser_.get());
    }

    void stop(Eigen::Index count, double* result, double* gradient, Eigen::Index unknowns) {
        std::fill(result, result + count, 0.0);
        if (gradient)
            std::fill(gradient, gradient + count * unknowns, 0.0);
        nlopt_force_stop(optimiser_.get());
    }

    struct Destroy {
        void operator()(nlopt_opt one) const { nlopt_destroy(one); }
    };
    ScaledWishes& wishes_;
    double share_;
    Candidate best_;
    std::optional<Eigen::VectorXd> seen_missing_;
    bool is_best_ = false;
    Eigen::Index idle_ = 0; ///< evaluations without a gain
    std::unique_ptr<nlopt_opt_s, Destroy> optimiser_;
};

/// Finds the local minimum near a design. If it meets a design without values, it continues in regions that shrink
/// towards it.
Candidate polish(ScaledWishes& wishes, Candidate best, double share) {
    constexpr int most_regions = 200, most_repetitions = 3;
    double radius = std::numeric_limits<double>::infinity();
    int repetitions = 0;
    for (int k = 0; k < most_regions && wishes.stop_reason == StopReason::none; ++k) {
        const Eigen::VectorXd low = wishes.lowest().cwiseMax((best.z.array() - radius).matrix()),
                              high = wishes.highest().cwiseMin((best.z.array() + radius).matrix());
        Programme programme(wishes, share);
        Candidate next = programme.run(best, low, high);
        const double moved = (next.z - best.z).lpNorm<Eigen::Infinity>(), merit = next.merit(share);
        const bool gains = best.merit(share) - merit > no_gain * (1 + merit);
        best = std::move(next);
        if (programme.is_best()) {
            break;
        } else if (programme.missing()) {
            radius = (*programme.missing() - best.z).lpNorm<Eigen::Infinity>() / 2;
            if (!(radius > least_region))
                break;
        } else if (moved >= radius * (1 - beside_face)) {
            radius *= 2;
        } else if (!gains || ++repetitions > most_repetitions) {
            break; // another run with fresh second derivatives gave no gain
        }
    }
    return best;
}

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

Candidate minimise_penalty(ScaledWishes& wishes, Candidate best) {
    for (const double share : distance_shares) {
        if (wishes.size() == 0 || wishes.rows().empty())
            break;
        best = polish(wishes, std::move(best), share);
        if (wishes.stop_reason != StopReason::none || best.violation <= wishes.options().tolerance)
            break;
        // If limits alone determine the least violation, the distance has no influence.
        if (const Multipliers held = multipliers_of_violation(wishes, best);
            held.residual < stationary && held.gap < stationary)
            break;
    }
    return best;
}

} // namespace graze
