#pragma once

#include "grazing/return_map.hpp"

#include <Eigen/Core>

#include <optional>

namespace graze {

/// What a motion that leaves a touch with the gain first s + second s^2 has gained when it is back, to the same order.
struct SecondGain {
    Eigen::VectorXd first, second; ///< of the states, on the surface where the touched function has no rate
    double value = 0;              ///< of the touched function, by s^2
};

/// Carries both around the orbit of a return map, by second derivatives of flows, events and jumps. @param back of the
/// touch, which is inside its arc
/// @return none where a derivative is not finite
std::optional<SecondGain> second_return(const OrbitEquations& equations, const OrbitEvaluation& at,
                                        const ReturnMap& back, const TouchFunctions& functions,
                                        const Eigen::VectorXd& first, const Eigen::VectorXd& second);

} // namespace graze
