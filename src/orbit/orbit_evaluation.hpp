#pragma once

#include "graze/flow/watched_series.hpp"
#include "orbit/cyclic_system.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// The equations of an orbit and their derivatives at given unknowns. It is a value that may be kept and reused.
struct OrbitEvaluation {
    OrbitEvaluation(std::size_t states, std::size_t free) : system(states, free) {}

    /// One piece: the states before and after its end, with derivatives. Columns are derivatives with respect to the
    /// states at its start (`flow`) or at its end (`jump`), then to the free parameters.
    struct Piece {
        std::vector<double> end;   ///< state at the end, before the jump
        std::vector<double> after; ///< state after the jump
        Eigen::MatrixXd flow;      ///< derivatives of `end`, states x (states + free)
        WatchedSeries watched;     ///< event functions along the piece, if it was integrated
        Eigen::VectorXd field;     ///< vector field at the end
        Eigen::VectorXd by_time; ///< derivative of `end` with respect to the duration; equals `field` for an exact flow
        Eigen::MatrixXd inner; ///< derivatives of the inner unknowns with respect to start, duration, free parameters;
                               ///< last column: their defect
        Eigen::MatrixXd jump;  ///< derivatives of `after`, states x (states + free)
        Eigen::VectorXd condition;  ///< gradient of the end condition, for the last piece of a segment: states + free
        double condition_value = 0; ///< value of the end condition, zero on the orbit
        double condition_unit = 1;  ///< unit by which the row of the condition is divided
    };

    Eigen::VectorXd unknowns; ///< unknowns of the evaluation; empty when it failed, and `problem` says why
    Eigen::VectorXd scales;   ///< scales of the unknowns and equations
    std::vector<double> parameters, periods;
    std::vector<Piece> pieces;
    std::vector<std::size_t> active; ///< states that are neither drifting nor neutral
    Eigen::VectorXd effects;         ///< largest derivative of the scaled equations with respect to each free parameter
    CyclicSystem system;             ///< the linearised equations, scaled
    double residual = 0;             ///< largest scaled residual
    std::string problem;
    bool took_too_long = false; ///< a segment takes too many steps: callers should not retry often

    bool is_at(const Eigen::VectorXd& u) const { return unknowns.size() == u.size() && unknowns == u; }
};

} // namespace graze
