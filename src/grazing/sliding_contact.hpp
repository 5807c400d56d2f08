#pragma once

#include "grazing/touch_geometry.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <string>

namespace graze {

/// What a motion gains that would go a depth d beyond the surface, and slides or sticks on it instead for a moment.
struct SlidingContact {
    std::string reason;   ///< why it is not in proportion to d; empty if it is
    Eigen::VectorXd gain; ///< of the states, by d
    Eigen::VectorXd next; ///< the next order, by d^(3/2)
};

/// Sliding begins on the surface h = 0, and ends where the touching mode's rate v of h turns positive there (grazing-
/// sliding: M. di Bernardo, P. Kowalczyk and A. B. Nordmark, Physica D 170, 2002). On the surface the difference D of
/// the fields is M v + ..., with h_x M = -1. The flow of the touching mode is taken out of the motion, which leaves
/// y' = D + t [D], integrated over the time on the surface: from -s/a - j s^2/(6 a^3) to 0.
/// @param mode in which it slides; @param contacts the transitions to it and back
SlidingContact sliding_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                               const TouchSizes& sizes, std::size_t mode, std::span<const std::size_t> contacts);

} // namespace graze
