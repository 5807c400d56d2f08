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

/// Detail of the point at which a branch or curve meets a branch of simpler orbits and ends.
inline constexpr char returned_to_simpler[] = "back on the branch of simpler orbits";

/// True when an orbit is one of half the period traversed twice, or its own image under a symmetry.
/// @param same scaled tolerance of differences
bool is_degenerate(BranchState& state, const Orbit& orbit, double same);
/// True for a branch point with such an orbit: there a branch of doubled or asymmetric orbits meets the branch of
/// simpler orbits.
bool is_degenerate(BranchState& state, const SpecialPoint& special);

/// Returns by how much the second half of an orbit's segments differs from the first, and from its images under the
/// symmetries: one list for each of these for which the halves have the same modes. All numbers of one list vanish and
/// change their sign together where a curve meets simpler orbits.
/// @param scaled whether in units of the unknowns' sizes
std::vector<std::vector<double>> differences_of_halves(BranchState& state, const Orbit& orbit, bool scaled = true);

/// Drops points that are consequences of others at the same place: those of a higher rank, and others by rules of their
/// own. @param length of the step in which they were found
void drop_consequences(BranchState& state, std::vector<SpecialPoint>& found, double length);

} // namespace graze
