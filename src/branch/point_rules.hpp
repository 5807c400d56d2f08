#pragma once

#include "branch/branch_state.hpp"

#include <vector>

namespace graze {

// Rules that select and merge the located zeros of tests.

/// Returns the rank of a point among several at the same place: the lowest is kept. Negative for points that do not
/// exclude others.
int rank(const SpecialPoint& point);

/// Largest scaled difference, due to round-off, between a solution and its repetition or image.
inline constexpr double same_orbit = 1e-6;

/// True when an orbit is one of half the period traversed twice, or its own image under a symmetry.
/// @param same scaled tolerance of differences
bool is_degenerate(BranchState& state, const Orbit& orbit, double same);
/// True for a branch point with such an orbit: there a branch of doubled or asymmetric orbits meets the branch of
/// simpler orbits.
bool is_degenerate(BranchState& state, const SpecialPoint& special);

/// Drops points that are consequences of others at the same place: those of a higher rank, and others by rules of their
/// own. @param length of the step in which they were found
void drop_consequences(BranchState& state, std::vector<SpecialPoint>& found, double length);

} // namespace graze
