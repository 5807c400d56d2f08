#pragma once

#include "grazing/touch_geometry.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <string>

namespace graze {

/// The shift of a motion that would penetrate to a depth d, and instead slides or sticks on the surface for a short
/// time.
struct SlidingContact {
    std::string reason;   ///< why the shift is not linear in d; empty if it is
    Eigen::VectorXd gain; ///< shift of the states, per unit of d
    Eigen::VectorXd next; ///< next order, per unit of d^(3/2)
};

/// Sliding begins on the surface h = 0, and ends where the touching mode's rate v of h turns positive there (grazing-
/// sliding: M. di Bernardo, P. Kowalczyk and A. B. Nordmark, Physica D 170, 2002). On the surface the difference D of
/// the fields is M v + ..., with h_x M = -1. Pulled back by the flow of the touching mode, the motion obeys y' = D + t
/// [D], which is integrated over the time on the surface: from -s/a - j s^2/(6 a^3) to 0.
/// @param mode the sliding mode; @param contacts transitions to it and back
SlidingContact sliding_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                               const TouchSizes& sizes, std::size_t mode, std::span<const std::size_t> contacts);

} // namespace graze
