#pragma once

#include "design/scaled_wishes.hpp"

#include <Eigen/Core>

namespace graze {

/// A design with its evaluation.
struct Candidate {
    Eigen::VectorXd z;
    Evaluation at;
    double violation = 0; ///< largest violation of limits without a cap

    /// Objective: violation plus `share` times half the squared distance.
    double merit(double share) const { return violation + share * z.squaredNorm() / 2; }
};

/// Minimises the exact penalty from a design, with a decreasing weight of the distance until all requirements that can
/// be met are met. Limits with a cap respect it.
Candidate minimise_penalty(ScaledWishes& wishes, Candidate best);

} // namespace graze
