#pragma once

#include "grazing/touch_geometry.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>

namespace graze {

/// What the states gain by the square of the approach speed at a touch after which a single jump is made: the next
/// order of its square-root map. @param transition of the touching mode, after which the mode is the same
/// @return none where derivatives of the model are not finite
std::optional<Eigen::VectorXd> next_order_of_impact(const TouchFunctions& functions, const TouchState& touch,
                                                    const TouchGeometry& geometry, const TouchSizes& sizes,
                                                    std::size_t transition);

} // namespace graze
