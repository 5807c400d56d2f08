#pragma once

#include "identify/fit_rows.hpp"

#include <functional>
#include <vector>

namespace graze {

/// One minimisation, with pieces joined more or less strictly.
struct FitStage {
    double joint = 1;         ///< what a gap of the size of the state weighs, beside what is left of readings by range
    bool states_only = false; ///< parameters, gains and offsets stay as they are
    int most_iterations = 100;
    std::vector<bool> active{}; ///< pieces that take part; empty: all
    std::vector<int> held{};    ///< shared unknowns that stay where they are
    double prior = 0;           ///< what moving by its scale weighs of each unknown
    double tolerance = 1e-15;   ///< relative change of the sum of squares that ends it
};

struct StageReport {
    bool converged = false, interrupted = false;
    bool failed = false; ///< nothing could be evaluated at the point itself
    bool least = false;  ///< nothing beside the point is better (DescentReport)
    int iterations = 0;
    double cost = 0;   ///< half the sum of squares that is left
    double gained = 0; ///< by how much that is less than at the beginning
};

/// What is told after each iteration: its number, and half the sum of squares. @return false to end
using StageProgress = std::function<bool(int iteration, double cost, const FitPoint& point)>;

/// Moves a point to where the sum of squares is least.
StageReport minimise(FitRows& rows, FitPoint& point, const FitStage& stage, const StageProgress& progress);

} // namespace graze
