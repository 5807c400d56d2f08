#pragma once

#include "graze/flow/watched_series.hpp"
#include "orbit/cyclic_system.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// What evaluating an orbit's equations at some unknowns gives: a value, which may be kept and used again.
struct OrbitEvaluation {
    OrbitEvaluation(std::size_t states, std::size_t free) : system(states, free) {}

    /// Of a piece. States before and after what ends it, with derivatives: columns are the states at its start (of
    /// `flow`) or at its end (of the others), then the free parameters.
    struct Piece {
        std::vector<double> end;    ///< state at its end, before the jump
        std::vector<double> after;  ///< and after
        Eigen::MatrixXd flow;       ///< derivatives of `end`, states x (states + free)
        WatchedSeries watched;      ///< events on the way, where it has been followed step by step
        Eigen::VectorXd field;      ///< rates at its end
        Eigen::VectorXd by_time;    ///< derivatives of `end` with respect to the duration: `field`, if followed exactly
        Eigen::MatrixXd inner;      ///< of inner unknowns with respect to start, duration, free parameters; last, what
                                    ///< they lack
        Eigen::MatrixXd jump;       ///< derivatives of `after`, states x (states + free)
        Eigen::VectorXd condition;  ///< gradient of the end condition, if it is its segment's last: states + free
        double condition_value = 0; ///< zero on the orbit
        double condition_unit = 1;  ///< by which its row is divided
    };

    Eigen::VectorXd unknowns; ///< at which it was made; empty: it failed, and `problem` says why
    Eigen::VectorXd scales;   ///< by which the equations were measured
    std::vector<double> parameters, periods;
    std::vector<Piece> pieces;
    std::vector<std::size_t> active; ///< states that are neither drifting nor unchanged by everything
    Eigen::VectorXd effects;         ///< of the free parameters on the equations, in units of the states' scales
    CyclicSystem system;             ///< the linear equations, in units of the scales
    double residual = 0;             ///< largest of the equations', in the same units
    std::string problem;
    bool took_too_long = false; ///< a segment takes too many steps: not to be tried too often

    bool is_at(const Eigen::VectorXd& u) const { return unknowns.size() == u.size() && unknowns == u; }
};

} // namespace graze
