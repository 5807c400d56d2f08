#pragma once

#include "branch/point_kind.hpp"

namespace graze {

// Points at which periods, parameters and monitors have extrema or values that were asked for: see PointRule.

void test_extremum(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_extremum(BranchState& state, SpecialPoint& special, const BranchTest& test);
void test_crossings(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_crossing(BranchState& state, SpecialPoint& special, const BranchTest& test);

} // namespace graze
