#pragma once

#include "graze/branch/continuation.hpp"

namespace graze {

/// Returns the largest length of the next step of a continuation, from its last two points.
///
/// The scale of a state that oscillates slightly about a growing mean is its oscillation, which would make steps very
/// small. Where a branch is straight, unknowns are measured by their values instead, if these are larger, up to a
/// factor of ten, so that special points are not passed over. A branch is straight where no component of the unit
/// tangent changes by more than a tenth; near a fold that of the parameter does.
/// @param largest the largest step in scaled unknowns, which is always allowed
double longest_step(const ContinuationProblem& problem, const ContinuationPoint& from, const ContinuationPoint& to,
                    double largest);

} // namespace graze
