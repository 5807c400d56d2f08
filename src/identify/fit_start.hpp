#pragma once

#include "identify/fit_rows.hpp"

namespace graze {

/// Returns the starting point of a fit: parameters as guessed; states from readings that show them directly, otherwise
/// by following the motion from piece to piece. Sets the layout's scales, and the modes of its pieces.
FitPoint starting_point(FitRows& rows);

/// Sets the initial state of a piece to the final state of the one before. @param read whether states that are read
/// directly are taken from the readings instead
void continue_from(FitRows& rows, FitPoint& point, std::size_t piece, bool read = true);

/// Whether a piece ends in a state that is constrained, as where friction has brought a mass to rest: then no piece
/// with free initial states can start there.
bool ends_constrained(FitRows& rows, const FitPoint& point, std::size_t piece);
/// Merges a piece with the one before it.
void merge(FitRows& rows, FitPoint& point, std::size_t piece);
/// Merges all pieces that would start in a constrained state. @return whether there were any
bool merge_constrained(FitRows& rows, FitPoint& point);

/// Sets the mode of each piece to the one in which the piece before it ends. @return whether a mode has changed
bool update_modes(FitRows& rows, const FitPoint& point);

/// Returns candidates for the initial state of a record that small steps from the present one would not reach:
///
/// other phases of cyclic states that no output shows, all around their period, unless the readings of the first piece
/// hardly depend on the phase; and states on the other side of a contact close to the first reading. Without a velocity
/// reading, a motion that leaves a stop and one about to hit it look alike.
std::vector<Eigen::VectorXd> other_initial_states(FitRows& rows, const FitPoint& point, std::size_t piece);

} // namespace graze
