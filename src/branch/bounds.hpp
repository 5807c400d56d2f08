#pragma once

#include "branch/point_kind.hpp"
#include "graze/branch/orbit_branch.hpp"

#include <span>
#include <vector>

namespace graze {

// Bounds of what varies along a branch, and of monitors: no point of the branch lies beyond one.

/// The tests of all bounds, always in the same order: positive within. Their noise is what round-off makes of them.
std::vector<BranchTest> tests_of_bounds(const BranchSettings& settings, std::span<const double> parameters,
                                        std::span<const double> monitors);
void test_bounds(const TestedPoint& point, std::vector<BranchTest>& tests);
bool confirm_bound(BranchState& state, SpecialPoint& special, const BranchTest& test);

/// Whether some of these tests are bounds beyond which a point lies, by more than round-off.
bool is_beyond_bounds(const std::vector<BranchTest>& tests);
/// Where a point that lies beyond bounds does so, in words.
std::string beyond_in_words(const BranchState& state, const BranchPoint& point);
/// Puts parameters that round-off has left beyond their bounds on these.
void put_on_bounds(const BranchSettings& settings, Orbit& orbit);

} // namespace graze
