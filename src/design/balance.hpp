#pragma once

#include "design/wish_programme.hpp"

#include <Eigen/Core>

namespace graze {

/// Of a limit or an end of a range, in scales: so near it is reached.
inline constexpr double beside_limit = 1e-7;

/// What holds a design where it is.
struct Balance {
    Eigen::VectorXd rows, lowest, highest; ///< multipliers: of limits, and of both ends of ranges
    double residual = 0;                   ///< what is left of the gradient
    double gap = 0;                        ///< violation by which limits that hold it are not quite reached
};

/// @param pull what else draws at the design, which limits and ranges are to balance
/// @param gives_way the limits without cap are reached at the design's violation, and their multipliers add up to one;
///        false: they are reached where they are not violated
Balance balance_at(const ScaledWishes& wishes, const Candidate& at, const Eigen::VectorXd& pull, bool gives_way);

/// Of the largest violation alone.
Balance balance_of_violation(const ScaledWishes& wishes, const Candidate& at);
/// Of the distance, where it is violated no more than the tolerance.
Balance balance_of_distance(const ScaledWishes& wishes, const Candidate& at);
/// Whether nothing near is better, by Candidate::merit.
bool is_best(const ScaledWishes& wishes, const Candidate& at, double share);

} // namespace graze
