#pragma once

#include "graze/trajectory/trajectory.hpp"

#include <functional>

namespace graze {

/// Runs one trajectory to its end, or until `stopped` returns true, which is called after each step.
/// @param stopped may be null
/// @return whether the end was reached
/// @throws InputError for jets of another simulation, or of several lanes
bool run_until(Trajectory& trajectory, JetSet& jets, const std::function<bool()>& stopped);

} // namespace graze
