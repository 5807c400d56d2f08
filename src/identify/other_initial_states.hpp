#pragma once

#include "identify/fit_rows.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace graze {

/// Returns candidates for the initial state of a record that small steps from the present one would not reach:
///
/// other phases of cyclic states that no output shows, all around their period, unless the readings of the first piece
/// hardly depend on the phase; and states on the other side of a contact close to the first reading. Without a velocity
/// reading, a motion that leaves a stop and one about to hit it look alike.
std::vector<Eigen::VectorXd> other_initial_states(FitRows& rows, const FitPoint& point, std::size_t piece);

} // namespace graze
