#pragma once

#include "branch/branch_state.hpp"

#include <vector>

namespace graze {

// What is made of the zeros of tests that have been located.

/// Of several things at one place, the one that tells most comes first. Negative for those that do not exclude others.
int rank(const SpecialPoint& point);

/// Whether an orbit is that of half the period twice over, or its own image under a symmetry.
/// @param same differences below this, in units of the scales, do not count
bool is_degenerate(BranchState& state, const Orbit& orbit, double same);
/// Whether that is so at a branch point: there a branch of less regular orbits comes back to the one that it left.
bool is_degenerate(BranchState& state, const SpecialPoint& special);

/// Of several points at the same place that are consequences of one another, only the first in rank is kept.
/// @param length of the step in which they were found
void merge(std::vector<SpecialPoint>& found, double length);

/// Where a contact vanishes, the orbit meets those on which it takes no time at all: solutions of the equations, but no
/// branch of orbits. A crossing near such a point is dropped if the equations are singular at that point itself.
void drop_crossings_of_nothing(BranchState& state, std::vector<SpecialPoint>& found, double length);

/// Where the pair that a curve keeps on the unit circle becomes real it is 1 or -1 twice: no fold or flip besides.
void drop_multipliers_of_resonances(std::vector<SpecialPoint>& found, double length);

/// With two multipliers folds and flips of impacting orbits end where impacts do not act on the next pass, which is one
/// point then.
void drop_parts_of_sensitivity(std::vector<SpecialPoint>& found, double length);

/// Where a branch comes back to the one that it left, the parameter turns: no fold of its own.
void drop_folds_of_return(BranchState& state, std::vector<SpecialPoint>& found, double length);

/// Where another branch crosses just where this one turns, as a pitchfork seen from the branch that begins there, that
/// is one point: the fold is left out.
void drop_turns_at_branch_points(std::vector<SpecialPoint>& found, double length);

} // namespace graze
