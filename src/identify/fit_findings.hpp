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

/// An alternative solution, as a point of the fit.
struct FoundSolution {
    AlternativeSolution solution;
    FitPoint point;
    std::vector<std::size_t> modes; ///< modes of its pieces
    std::size_t changed_signs = 0;  ///< see `changed_signs_of`
};

/// Returns how many parameters and gains differ in sign from their guesses.
std::size_t changed_signs_of(const FitTask& task, const std::vector<double>& shared);

/// Searches for other solutions that fit the readings equally well: with the signs of up to three numbers changed,
/// phases shifted by half a period, all states reflected, or by a symmetry that the model declares, alone or together
/// with the signs of gains. Only numbers that differ from 0 by clearly more than their errors are considered.
/// @param known all evaluated pieces at the point. @param fit with its numbers
std::vector<FoundSolution> alternative_solutions(FitRows& rows, const FitPoint& point,
                                                 const std::vector<PieceRows>& known, const Fit& fit);

/// A channel that the model does not reproduce.
struct FitMismatch {
    std::size_t output = 0, record = 0;
    double since = 0; ///< time from which on it differs
    double size = 0;  ///< root mean square of the residuals, relative to the range of the readings
    /// Ratio of readings to model values if they are proportional; otherwise 0.
    double factor = 0;
};

/// Returns the channels whose residuals are far larger than those of a fit that may still converge. @param known the
/// evaluated pieces, some of which may not be finite
std::vector<FitMismatch> mismatches_of(const FitRows& rows, const std::vector<PieceRows>& known);
/// Describes mismatches in one line; empty if there are none.
std::string text_of(const std::vector<FitMismatch>& mismatches, const FitTask& task);

} // namespace graze
