#pragma once

#include "grazing/return_map.hpp"

#include <Eigen/Core>

#include <optional>

namespace graze {

/// The shift of a motion after one cycle, to second order in s.
struct SecondGain {
    Eigen::VectorXd first,
        second;       ///< coefficients of the states, on the surface where the touched function has zero rate
    double value = 0; ///< coefficient of s^2 of the touched function
};

/// Propagates the shift first s + second s^2 of a touch around the orbit by second derivatives of flows, events and
/// jumps. @param back return map of the touch, which lies inside its arc
/// @return empty where a derivative is not finite
std::optional<SecondGain> second_return(const OrbitEquations& equations, const OrbitEvaluation& at,
                                        const ReturnMap& back, const TouchFunctions& functions,
                                        const Eigen::VectorXd& first, const Eigen::VectorXd& second);

} // namespace graze
