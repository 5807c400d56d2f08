#pragma once

#include "branch/branch_state.hpp"

#include <vector>

namespace graze {

// Rules that select and merge the located zeros of tests.

/// Returns the rank of a point among several at the same place: the lowest is kept. Negative for points that do not
/// exclude others.
int rank(const SpecialPoint& point);

/// True when an orbit is one of half the period traversed twice, or its own image under a symmetry.
/// @param same scaled tolerance of differences
bool is_degenerate(BranchState& state, const Orbit& orbit, double same);
/// True for a branch point with such an orbit: there a branch of doubled or asymmetric orbits meets the branch of
/// simpler orbits.
bool is_degenerate(BranchState& state, const SpecialPoint& special);

/// Merges points at the same place that are consequences of one another: only the first in rank is kept.
/// @param length of the step in which they were found
void merge(std::vector<SpecialPoint>& found, double length);

/// Drops branch points near the end of a contact. There the branch meets solutions with a segment of zero duration,
/// which are not orbits; the crossing is dropped if the equations are singular at the end point itself.
void drop_spurious_crossings(BranchState& state, std::vector<SpecialPoint>& found, double length);

/// Drops folds and flips at 1:1 and 1:2 resonances, where the kept pair of multipliers becomes 1 or -1.
void drop_multipliers_of_resonances(std::vector<SpecialPoint>& found, double length);

/// Merges the ends of the curves of folds and flips of impacting orbits into the point of vanishing sensitivity, with
/// which they coincide for two multipliers.
void drop_parts_of_sensitivity(std::vector<SpecialPoint>& found, double length);

/// Drops folds where a branch returns to the branch of simpler orbits: the parameter has an extremum there.
void drop_folds_at_return(BranchState& state, std::vector<SpecialPoint>& found, double length);

/// Drops folds that coincide with a branch point, as at a pitchfork seen from the bifurcating branch.
void drop_folds_at_branch_points(std::vector<SpecialPoint>& found, double length);

} // namespace graze
