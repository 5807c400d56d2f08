#pragma once

#include "identify/fit_information.hpp"

namespace graze {

// What follows is said of a point at which all pieces have been evaluated: `known` has them in their order. All but
// `unreadable` want all of them finite.

/// What of the readings cannot be computed. Empty if all can.
std::string unreadable(const FitRows& rows, const std::vector<PieceRows>& known);

/// Puts into a fit what is known at a point: numbers with their errors, what is not told, how well readings are met.
/// @param joint weight of gaps at which the point was found
void describe(FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known, double joint, Fit& fit);

/// What makes a point the result, or not: half of the reasons are words for Fit::detail.
struct FitChecks {
    double off = 0;        ///< how far a further step would change the numbers, relative to their errors
    bool held_well = true; ///< numbers at bounds would go beyond
    double gap = 0, allowed_gap = 0;
    std::string broken; ///< the first motion that ends early; empty without
    bool modes_agree = true;

    /// It is a motion from the beginning of each record to its end.
    bool joined() const { return broken.empty() && modes_agree && gap <= allowed_gap; }
};
FitChecks check_point(const FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known, double joint);

/// Shared unknowns that are at a bound.
std::vector<int> bounded_at(const FitRows& rows, const FitPoint& point);

/// The negative logarithm of how likely the readings are, but for a constant: with noise of each output as it is left,
/// or was given. Of two motions the one that has less is better.
double unlikelihood_of(const FitRows& rows, const std::vector<PieceRows>& known);
/// Whether all readings are met but for round-off.
bool is_exact(const FitRows& rows, const std::vector<PieceRows>& known);

/// Standard deviations of what is left of each output.
std::vector<double> noise_at(const FitRows& rows, const std::vector<PieceRows>& known);

} // namespace graze
