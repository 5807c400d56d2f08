#pragma once

#include "graze/flow/system.hpp"
#include "graze/grazing/discontinuity_map.hpp"

#include <Eigen/Core>

#include <cstddef>

namespace graze {

/// The vector field of another mode minus that of the touching mode, at a touch, with derivatives.
struct FieldDifference {
    Eigen::VectorXd value, second; ///< difference, and its second derivative along the field of the touching mode
    double jerk = 0;               ///< third time derivative of the touched function
    Eigen::MatrixXd derivatives;   ///< Jacobian of the difference, states x states
    Eigen::MatrixXd of_field;      ///< Jacobian of the touching mode's field
};
/// Computes the difference at a touch. @param mode the other mode
FieldDifference difference_of(const System& system, const TouchState& touch, std::size_t mode);

} // namespace graze
