#pragma once

#include "grazing/touch_geometry.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace graze {

/// The shift of a motion by a contact with another mode, whose vector field equals that of the touching mode at the
/// touch, on a motion that penetrates, or would penetrate, to a depth d.
struct ContactEffect {
    std::string reason;   ///< why the shift is not of the order that is examined; empty if it is
    Eigen::VectorXd gain; ///< shift of the states: per unit of d^(3/2) if compliant, of d if sliding
    Eigen::VectorXd next; ///< sliding: next order, per unit of d^(3/2)
};

/// Let D be the difference of the vector fields, which near the touch is N h + M h' with vectors N (stiffness) and M
/// (damping). Pulled back by the flow of the touching mode, the motion obeys y' = D + t [D] + t^2/2 [[D]] with Lie
/// brackets along the field, which is integrated over the time beyond the surface (di Bernardo et al. 2008, section
/// 7.2, where M is zero).
/// @param mode during the contact
ContactEffect compliant_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                                const TouchSizes& sizes, std::size_t mode);

/// Sliding begins on the surface h = 0, and ends where the touching mode's rate v of h turns positive there (grazing-
/// sliding: M. di Bernardo, P. Kowalczyk and A. B. Nordmark, Physica D 170, 2002). On the surface the difference D of
/// the fields is M v + ..., with h_x M = -1. Pulled back by the flow of the touching mode, the motion obeys y' = D + t
/// [D], which is integrated over the time on the surface: from -s/a - j s^2/(6 a^3) to 0.
/// @param mode the sliding mode; @param contacts transitions to it and back
ContactEffect sliding_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                              const TouchSizes& sizes, std::size_t mode, std::span<const std::size_t> contacts);

/// Returns the s^2 coefficient of the shift of the states at a touch with a single jump: the next order of the
/// square-root map. @param transition of the touching mode that returns to the same mode
/// @return empty where derivatives of the model are not finite
std::optional<Eigen::VectorXd> next_order_of_impact(const TouchFunctions& functions, const TouchState& touch,
                                                    const TouchGeometry& geometry, const TouchSizes& sizes,
                                                    std::size_t transition);

} // namespace graze
