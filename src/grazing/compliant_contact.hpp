#pragma once

#include "grazing/touch_geometry.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <string>

namespace graze {

/// What a contact with another mode, whose field is the same at the touch, makes of a motion that goes a depth d beyond
/// the surface.
struct CompliantContact {
    std::string reason;   ///< why it does not act as a power 3/2; empty if it does
    Eigen::VectorXd gain; ///< of the states, by d^(3/2)
};

/// With D the difference of the fields, which beside the touch is N h + M h' for some vectors N (stiffness) and M
/// (damping), the flow of the touching mode is taken out of the motion, which leaves y' = D + t [D] + t^2/2 [[D]] with
/// brackets of Lie along the field, integrated over the time beyond the surface (di Bernardo et al. 2008, section 7.2,
/// where M is zero).
/// @param mode in contact
CompliantContact compliant_contact(const TouchFunctions& functions, const TouchState& touch,
                                   const TouchGeometry& geometry, const TouchSizes& sizes, std::size_t mode);

} // namespace graze
