#pragma once

#include "grazing/touch_geometry.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <string>

namespace graze {

/// The effect of a contact with another mode, whose vector field equals that of the touching mode at the touch, on a
/// motion that penetrates to a depth d.
struct CompliantContact {
    std::string reason;   ///< why the effect is not of order 3/2; empty if it is
    Eigen::VectorXd gain; ///< shift of the states, per unit of d^(3/2)
};

/// Let D be the difference of the vector fields, which near the touch is N h + M h' with vectors N (stiffness) and M
/// (damping). Pulled back by the flow of the touching mode, the motion obeys y' = D + t [D] + t^2/2 [[D]] with Lie
/// brackets along the field, which is integrated over the time beyond the surface (di Bernardo et al. 2008, section
/// 7.2, where M is zero).
/// @param mode during the contact
CompliantContact compliant_contact(const TouchFunctions& functions, const TouchState& touch,
                                   const TouchGeometry& geometry, const TouchSizes& sizes, std::size_t mode);

} // namespace graze
