#pragma once

#include "branch/point_kind.hpp"

namespace graze {

// Tests, confirmation and conditions of points with multipliers on the unit circle, and of their degeneracies: see
// PointRule.

void test_fold(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_fold(BranchState& state, SpecialPoint& special, const BranchTest&);
std::unique_ptr<OrbitCondition> condition_of_fold(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                  const SpecialPoint&);
void test_flip(const TestedPoint& point, std::vector<BranchTest>& tests);
void test_asymmetry(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_flip(BranchState& state, SpecialPoint& special, const BranchTest&);
std::unique_ptr<OrbitCondition> condition_of_flip(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                  const SpecialPoint&);
std::vector<BranchStart> leave_flip(const System& system, const SpecialPoint& point, const BranchSettings& settings);
std::vector<BranchStart> leave_asymmetry(const System& system, const SpecialPoint& point,
                                         const BranchSettings& settings);
void test_branch_point(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_branch_point(BranchState& state, SpecialPoint& special, const BranchTest&);
std::vector<BranchStart> leave_branch_point(const System& system, const SpecialPoint& point,
                                            const BranchSettings& settings);
void test_torus(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_torus(BranchState& state, SpecialPoint& special, const BranchTest&);
std::unique_ptr<OrbitCondition> condition_of_torus(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                   const SpecialPoint&);
bool confirm_fold_flip(BranchState& state, SpecialPoint& special, const BranchTest&);
bool confirm_with_torus(BranchState& state, SpecialPoint& special, const BranchTest&);
bool confirm_resonance(BranchState& state, SpecialPoint& special, const BranchTest&);
bool confirm_cusp(BranchState& state, SpecialPoint& special, const BranchTest&);
bool confirm_generalised(BranchState& state, SpecialPoint& special, const BranchTest&);

/// Adds the tests of a degeneracy along a curve, which the curve's condition provides.
template <PointType Type>
void test_degeneracy(const TestedPoint& point, std::vector<BranchTest>& tests) {
    for (const Degeneracy& one : point.degeneracies)
        if (one.type == Type)
            tests.push_back({.type = Type, .value = one.value, .noise = one.noise});
}

} // namespace graze
