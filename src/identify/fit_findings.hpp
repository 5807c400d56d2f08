#pragma once

#include "identify/fit_information.hpp"

namespace graze {

// Functions of a point at which all pieces have been evaluated: `known` holds the evaluated pieces in their order. All
// but `unreadable` require all of them to be finite.

/// Returns why some readings cannot be computed; empty if all can.
std::string unreadable(const FitRows& rows, const std::vector<PieceRows>& known);

/// Fills in the result at a point: numbers with their errors, undetermined combinations, quality of the fit.
/// @param joint weight of gaps with which the point was found
void describe(FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known, double joint, Fit& fit);

/// Checks of a point that decide whether it is the result.
struct FitChecks {
    double remaining_step = 0; ///< size of the next Gauss-Newton step, relative to the standard errors
    bool bounds_hold = true;   ///< parameters at bounds would move further out if released
    double gap = 0, allowed_gap = 0;
    std::string broken; ///< why the first incomplete motion ended; empty if all are complete
    bool modes_agree = true;

    /// True when the pieces form one motion over each whole record.
    bool joined() const { return broken.empty() && modes_agree && gap <= allowed_gap; }
};
FitChecks check_point(const FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known, double joint);

/// Returns the indices of shared unknowns that are at a bound.
std::vector<int> parameters_at_bounds(const FitRows& rows, const FitPoint& point);

/// Returns the negative log-likelihood of the readings up to a constant, with the given or estimated noise of each
/// output. The smaller, the better the solution.
double negative_log_likelihood(const FitRows& rows, const std::vector<PieceRows>& known);
/// Returns true if all residuals are at the level of round-off.
bool is_exact(const FitRows& rows, const std::vector<PieceRows>& known);

/// Returns the noise of each output: given, or estimated from its residuals.
std::vector<double> noise_at(const FitRows& rows, const std::vector<PieceRows>& known);

} // namespace graze
