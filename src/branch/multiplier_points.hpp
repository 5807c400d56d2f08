#pragma once

#include "branch/point_kind.hpp"

namespace graze {

// Functions of points with multipliers on the unit circle, and of their degeneracies: see PointRule.

PointRule::Test test_fold, test_homoclinic_tangency, test_flip, test_asymmetry, test_branch_point, test_torus;
PointRule::Confirm confirm_fold, confirm_homoclinic_tangency, confirm_flip, confirm_branch_point, confirm_torus,
    confirm_beside_flip, confirm_with_torus, confirm_resonance, confirm_cusp;
PointRule::Condition condition_of_fold, condition_of_flip, condition_of_torus;
PointRule::Leave leave_flip, leave_asymmetry, leave_branch_point;

/// Adds the tests of a degeneracy along a curve, which the curve's condition provides.
template <PointType Type>
void test_degeneracy(const TestedPoint& point, std::vector<BranchTest>& tests) {
    // In families the third-order coefficient of a torus would need the orbits of equal energy beside this one: the
    // matrix that it solves with is singular along the family.
    if (Type == PointType::generalised_torus && point.settings.unfolded > 0)
        return;
    for (const Degeneracy& one : point.degeneracies)
        if (one.type == Type)
            tests.push_back({.type = Type, .value = one.value, .noise = one.noise});
}

} // namespace graze
