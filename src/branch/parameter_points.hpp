#pragma once

#include "branch/point_kind.hpp"

namespace graze {

// Tests and confirmation of extrema of periods and parameters, and of requested values of monitors: see PointRule.

void test_extremum(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_extremum(BranchState& state, SpecialPoint& special, const BranchTest& test);
void test_crossings(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_crossing(BranchState& state, SpecialPoint& special, const BranchTest& test);

} // namespace graze
