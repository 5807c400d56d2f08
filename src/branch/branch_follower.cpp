#include "branch/branch_follower.hpp"

namespace graze {

void BranchFollower::end_at(std::size_t i, BranchPoint& last) {
    found_.resize(i + 1);
    const SpecialPoint& special = found_[i];
    last.solution = special.solution;
    last.parameter = special.parameter;
    last.arclength = special.arclength;
    last.tangent = special.tangent;
    last.monitors = special.monitors;
    last.stable = is_stable(special.solution);
}

} // namespace graze
