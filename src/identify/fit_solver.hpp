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

} // namespace graze
