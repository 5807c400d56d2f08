#pragma once

#include "graze/trajectory/trajectory.hpp"

#include <functional>

namespace graze {

/// Drives one trajectory to its end, or until it is to be left as it is, which is asked after each step.
/// @param stopped may be null
/// @return whether the end was reached
/// @throws InputError for jets of another simulation, or of several lanes
bool run_until(Trajectory& trajectory, JetSet& jets, const std::function<bool()>& stopped);

} // namespace graze
