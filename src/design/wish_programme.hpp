#pragma once

#include "design/scaled_wishes.hpp"

#include <Eigen/Core>

namespace graze {

struct Candidate {
    Eigen::VectorXd z;
    Asked at;
    double violation = 0; ///< of the rows that may give way

    /// What is minimised.
    double merit(double share) const { return violation + share * z.squaredNorm() / 2; }
};

/// The exact penalty: from one design to the best near it, with the distance counting less and less until all that can
/// be met is. Limits with a cap keep it.
Candidate penalised(ScaledWishes& wishes, Candidate best);

} // namespace graze
