#pragma once

#include "branch/branch_state.hpp"

#include <optional>
#include <string>

namespace graze {

/// Returns the start of the branch beyond a point where two events change their order, a segment vanishes or a guard
/// chooses another mode: an orbit with the signature of the model's motion there.
/// @throws InputError when no orbit is found
BranchStart with_events_reordered(const System& system, const SpecialPoint& point, const BranchSettings& settings);

/// Continues a curve beyond such a point from the motion of the model near it. @return false when no orbit is found;
/// the state is then unusable
bool continue_reordered_curve(BranchState& state, const SpecialPoint& point);

/// Returns a message if the kept touch has reached an edge of its segment, beyond which it belongs to another segment;
/// empty otherwise.
std::string touch_at_edge(const BranchSettings& settings, const Orbit& orbit);
/// Continues a curve with the kept touch in the neighbouring segment. There the second derivative of the event function
/// jumps, while its value and rate are continuous. Beyond the ends of a half orbit its image touches the image of the
/// event. @return the first point there; empty when none is found
std::optional<DescribedPoint> continue_in_next_segment(BranchState& state, const BranchPoint& from);

} // namespace graze
