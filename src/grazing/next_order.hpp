#pragma once

#include "grazing/touch_geometry.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>

namespace graze {

/// Returns the s^2 coefficient of the shift of the states at a touch with a single jump: the next order of the
/// square-root map. @param transition of the touching mode that returns to the same mode
/// @return empty where derivatives of the model are not finite
std::optional<Eigen::VectorXd> next_order_of_impact(const TouchFunctions& functions, const TouchState& touch,
                                                    const TouchGeometry& geometry, const TouchSizes& sizes,
                                                    std::size_t transition);

} // namespace graze
