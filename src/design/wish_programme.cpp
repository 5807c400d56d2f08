#include "design/wish_programme.hpp"

#include "design/multipliers.hpp"
#include "orbit/eigen_index.hpp"

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
