#pragma once

#include "design/scaled_wishes.hpp"

namespace graze {

/// A design with its evaluation.
struct Candidate {
    Eigen::VectorXd z;
    Evaluation at;
    double violation = 0; ///< largest violation of limits without a cap

    /// Objective: violation plus `share` times half the squared distance.
    double merit(double share) const { return violation + share * z.squaredNorm() / 2; }
};

/// Distance from a limit or an end of a range, in scales, at which it counts as reached.
inline constexpr double limit_distance = 1e-7;

/// Lagrange multipliers of the limits and ranges that are active at a design.
struct Multipliers {
    Eigen::VectorXd rows, lowest, highest; ///< multipliers of limits, and of the lower and upper ends of ranges
    double residual = 0;                   ///< norm of the gradient that the multipliers do not multipliers
    double gap = 0;                        ///< complementarity: slack of limits with a multiplier
};

/// Computes the multipliers that best satisfy the stationarity condition.
/// @param pull gradient of the objective, which limits and ranges must balance
/// @param gives_way true: limits without a cap are active at the design's violation, and their multipliers sum to one;
/// false: they are active where they are just not violated
Multipliers multipliers_at(const ScaledWishes& wishes, const Candidate& at, const Eigen::VectorXd& pull,
                           bool gives_way);

/// Multipliers for minimising the largest violation alone.
Multipliers multipliers_of_violation(const ScaledWishes& wishes, const Candidate& at);
/// Multipliers for minimising the distance, at a design whose violations are within the tolerance.
Multipliers multipliers_of_distance(const ScaledWishes& wishes, const Candidate& at);
/// Whether a design is a local minimum of Candidate::merit, by its multipliers.
bool is_best(const ScaledWishes& wishes, const Candidate& at, double share);

/// Minimises the exact penalty from a design, with a decreasing weight of the distance until all requirements that can
/// be met are met. Limits with a cap respect it.
Candidate minimise_penalty(ScaledWishes& wishes, Candidate best);

} // namespace graze
