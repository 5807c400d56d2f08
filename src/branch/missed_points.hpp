#pragma once

#include "branch/branch_state.hpp"
#include "branch/crossing.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace graze {

/// Returns the multipliers of the half map for half orbits, otherwise of the orbit.
inline const std::vector<std::complex<double>>& multipliers_followed(const OrbitSolution& solution) {
    return solution.half_multipliers.empty() ? solution.multipliers : solution.half_multipliers;
}

/// A point of the last step, at a fraction of it.
struct StepSample {
    double fraction = 0;
    DescribedPoint here;
    /// Those that were computed.
    const std::vector<std::complex<double>>& multipliers() const { return multipliers_followed(here.point.solution); }
    std::size_t number_of_multipliers() const { return graze::number_of_multipliers(here.point.solution); }
};

/// Finds points of the last step at which multipliers cross the unit circle without a detected sign change. A test
/// function changes its sign once per crossing, so two crossings within one step go unnoticed, but the number of
/// unstable multipliers changes.
/// @param low, high ends of the searched part of the step; @param found known points of that part
/// @param locate finds the zero of a test between two of its values, of opposite signs
/// @return empty where the known points explain the number of unstable multipliers
using TestLocator = std::function<std::optional<SpecialPoint>(std::size_t test, const TestValue&, const TestValue&)>;
std::vector<SpecialPoint> missed_points(BranchState& state, const StepSample& low, const StepSample& high,
                                        const std::vector<SpecialPoint>& found, const TestLocator& locate);

} // namespace graze
