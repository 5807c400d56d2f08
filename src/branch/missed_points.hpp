#pragma once

#include "branch/branch_state.hpp"
#include "branch/crossing.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace graze {

/// A point of the last step, by the fraction of the step, with its tests and its multipliers.
struct StepSample {
    double fraction = 0;
    std::vector<BranchTest> tests;
    std::vector<std::complex<double>> multipliers;
};

/// Where a multiplier, or several at once, cross the unit circle within the last step although no point tells so. Test
/// functions change their signs once more for each multiplier: of two that cross within one step nothing is seen in
/// them. The number of unstable multipliers tells, and says where to look.
/// @param low, high ends of the part of the step in which is looked; @param found what is known of that part
/// @param locate finds the zero of a test between two of its values, of opposite signs
/// @return none where the number of unstable multipliers is explained by what is known
using TestLocator = std::function<std::optional<SpecialPoint>(std::size_t test, const TestValue&, const TestValue&)>;
std::vector<SpecialPoint> missed_points(BranchState& state, const StepSample& low, const StepSample& high,
                                        const std::vector<SpecialPoint>& found, const TestLocator& locate);

/// Multipliers of the shortest orbit that is followed: of the half of a symmetric one.
const std::vector<std::complex<double>>& multipliers_followed(const OrbitSolution& solution);

} // namespace graze
