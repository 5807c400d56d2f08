#pragma once

#include "identify/fit_rows.hpp"

namespace graze {

/// The point from which a fit begins: parameters as guessed, states from readings where these tell them and otherwise
/// by following the motion from piece to piece. Sets the layout's scales, and the modes of its pieces.
FitPoint starting_point(FitRows& rows);

/// Begins a piece anew where the one before it ends. @param read whether with the states that readings tell
void continue_from(FitRows& rows, FitPoint& point, std::size_t piece, bool read = true);

/// Whether a piece ends where not all states are free, as where friction has brought a mass to rest: no other can begin
/// there.
bool ends_bound(FitRows& rows, const FitPoint& point, std::size_t piece);
/// Makes a piece part of the one before it.
void merge(FitRows& rows, FitPoint& point, std::size_t piece);
/// The same for all pieces that cannot begin where they do. @return whether there were any
bool merge_bound(FitRows& rows, FitPoint& point);

/// The modes of pieces are those in which the ones before them end. @return whether one has changed
bool update_modes(FitRows& rows, const FitPoint& point);

} // namespace graze
