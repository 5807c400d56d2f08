#pragma once

#include "identify/fit_rows.hpp"

namespace graze {

/// The point from which a fit begins: parameters as guessed, states from readings where these tell them and otherwise
/// by following the motion from piece to piece. Sets the layout's scales, and the modes of its pieces.
FitPoint starting_point(FitRows& rows);

/// Begins a piece anew where the one before it ends, with the states that readings tell.
void continue_from(FitRows& rows, FitPoint& point, std::size_t piece);

/// The modes of pieces are those in which the ones before them end. @return whether one has changed
bool update_modes(FitRows& rows, const FitPoint& point);

} // namespace graze
