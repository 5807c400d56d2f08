#pragma once

namespace peers {

/// Compares trajectories, ensembles and derivatives of the vibro-impactor with heyoka.
/// @param quick true: takes seconds
void compare_trajectories(bool quick);

} // namespace peers
