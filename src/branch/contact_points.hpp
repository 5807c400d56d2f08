#pragma once

#include "branch/point_kind.hpp"

namespace graze {

// Tests, confirmation and conditions of points at which contacts appear or disappear or events change their order: see
// PointRule.

void test_grazing(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_grazing(BranchState& state, SpecialPoint& special, const BranchTest&);
bool confirm_double_grazing(BranchState& state, SpecialPoint& special, const BranchTest& test);
int rank_of_grazing(const SpecialPoint& point);
std::unique_ptr<OrbitCondition> condition_of_grazing(const OrbitEquations& equations, const OrbitEvaluation&,
                                                     const SpecialPoint& point);
std::vector<BranchStart> leave_double_grazing(const System& system, const SpecialPoint& point,
                                              const BranchSettings& settings);
std::vector<BranchStart> leave_grazing(const System& system, const SpecialPoint& point, const BranchSettings& settings);
void test_vanishing(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_vanishing(BranchState&, SpecialPoint& special, const BranchTest&);
std::unique_ptr<OrbitCondition> condition_of_vanishing(const OrbitEquations& equations, const OrbitEvaluation&,
                                                       const SpecialPoint& point);
void test_two_events(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_two_events(BranchState& state, SpecialPoint& special, const BranchTest& test);
std::unique_ptr<OrbitCondition> condition_of_two_events(const OrbitEquations& equations, const OrbitEvaluation&,
                                                        const SpecialPoint& point);
void test_guard(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_guard(BranchState& state, SpecialPoint& special, const BranchTest&);
std::unique_ptr<OrbitCondition> condition_of_guard(const OrbitEquations& equations, const OrbitEvaluation& at,
                                                   const SpecialPoint& point);
std::vector<BranchStart> leave_order(const System& system, const SpecialPoint& point, const BranchSettings& settings);
void test_sensitivity(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_sensitivity(BranchState& state, SpecialPoint& special, const BranchTest&);
bool confirm_degenerate_grazing(BranchState& state, SpecialPoint& special, const BranchTest& test);
void test_acceleration(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_acceleration(BranchState& state, SpecialPoint& special, const BranchTest&);

} // namespace graze
