#pragma once

#include "identify/fit_rows.hpp"

#include <functional>
#include <vector>

namespace graze {

/// Settings of one minimisation, with a given weight of the gaps between pieces.
struct FitStage {
    double joint = 1; ///< weight of a gap of one scale of the state, relative to residuals of one range of the readings
    bool states_only = false; ///< only initial states are fitted
    int most_iterations = 100;
    std::vector<bool> active{}; ///< pieces that are included; empty: all
    std::vector<int> held{};    ///< shared unknowns that are fixed
    double prior = 0;           ///< weight of moving an unknown by its scale
    double tolerance = 1e-15;   ///< relative change of the sum of squares that stops the iteration
};

/// Outcome of one minimisation.
struct StageReport {
    bool converged = false, interrupted = false;
    bool failed = false; ///< the initial point itself could not be evaluated
    bool least = false;  ///< no point near it is better (DescentReport)
    int iterations = 0;
    double cost = 0;   ///< half the remaining sum of squares
    double gained = 0; ///< decrease of the cost
};

/// Called after each iteration with its number and half the sum of squares. @return false to stop
using StageProgress = std::function<bool(int iteration, double cost, const FitPoint& point)>;

/// Moves a point to a minimum of the sum of squares (Levenberg-Marquardt, by Ceres Solver).
StageReport minimise(FitRows& rows, FitPoint& point, const FitStage& stage, const StageProgress& progress);

/// Outcome of `descend_joined`.
struct DescentReport {
    bool interrupted = false;
    bool least = false; ///< none of the motions tried near the last one fits better
    int iterations = 0;
};

/// Continues a fit with motions whose pieces join exactly: only the initial states of records and the parameters move,
/// and each piece starts where the one before it ends. Without the penalty of gaps the cost has no curved valley, in
/// which steps would be short.
///
/// Where a contact too slow to be told from noise passes a reading, the sum of squares has a step, and derivatives
/// cannot tell whether the edge of the step is the minimum. There each direction is also tried by parts of its standard
/// error.
///
/// The point stays unchanged if its gaps are so large (as in chaos) that no exactly joined motion fits as well.
/// @param joint weight of gaps. @param probe whether directions are tried at the end
/// @param tell is called with half the sum of squares after each iteration; returning false stops
DescentReport descend_joined(FitRows& rows, FitPoint& point, double joint, bool probe,
                             const std::function<bool(double)>& tell);

} // namespace graze
