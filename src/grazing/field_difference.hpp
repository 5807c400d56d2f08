#pragma once

#include "graze/flow/system.hpp"
#include "graze/grazing/discontinuity_map.hpp"

#include <Eigen/Core>

#include <cstddef>

namespace graze {

/// What another mode's field has more than that of the touching mode, at a touch, with derivatives.
struct FieldDifference {
    Eigen::VectorXd value, second; ///< and its second derivative along the touching mode's field
    double jerk = 0;               ///< third rate of the touched function
    Eigen::MatrixXd derivatives;   ///< states x states
    Eigen::MatrixXd of_field;      ///< of the touching mode's field
};
/// @param mode the other one
FieldDifference difference_of(const System& system, const TouchState& touch, std::size_t mode);

} // namespace graze
