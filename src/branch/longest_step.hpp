#pragma once

#include "graze/branch/continuation.hpp"

namespace graze {

/// How long the next step of a continuation may be, from its last two points.
///
/// What oscillates little about a mean that grows is measured by its oscillation, and would be followed in small shares
/// of that. Where a branch is straight, unknowns are measured by their values instead, if these are larger; by at most
/// ten times, as what an orbit meets within half its own extent is to be seen. A branch is straight where no unknown's
/// share of the tangent changes by more than a tenth: near a fold that of the parameter does, however small it is.
/// @param largest the longest step by the scales, which is always allowed
double longest_step(const ContinuationProblem& problem, const ContinuationPoint& from, const ContinuationPoint& to,
                    double largest);

} // namespace graze
