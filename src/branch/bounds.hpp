#pragma once

#include "branch/point_kind.hpp"
#include "graze/branch/orbit_branch.hpp"

#include <optional>
#include <span>
#include <vector>

namespace graze {

// Bounds of varying parameters and of monitors: no point of a branch lies beyond one.

/// Returns the tests of all bounds, always in the same order; positive inside, with round-off as their noise.
std::vector<BranchTest> tests_of_bounds(const BranchSettings& settings, std::span<const double> parameters,
                                        std::span<const double> monitors);
PointRule::Test test_bounds;
PointRule::Confirm confirm_bound;

/// True when one of the tests is a bound that is exceeded by more than round-off.
bool is_beyond_bounds(const std::vector<BranchTest>& tests);
/// Returns a description of the first bound that a point exceeds; empty if it exceeds none.
std::string beyond_in_words(const BranchState& state, const BranchPoint& point);
/// True when the first point of a branch lies on a bound of a parameter and the branch leads across it.
bool leads_beyond_bounds(BranchState& state);
/// True when a value of the parameter lies outside of its bounds.
inline bool is_outside(const BranchSettings& settings, double value) {
    return (settings.least && value < *settings.least) || (settings.greatest && value > *settings.greatest);
}
/// Clamps a value to bounds, of which either may be missing.
double within_bounds(double value, const std::optional<double>& least, const std::optional<double>& greatest);
/// Clamps parameters to their bounds, which round-off may have exceeded.
void put_on_bounds(const BranchSettings& settings, Orbit& orbit);

} // namespace graze
