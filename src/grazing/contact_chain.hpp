#pragma once

#include "grazing/touch_geometry.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// What a contact of vanishing approach speed s sets off, to first order in s: the jump, further modes that last for a
/// time in proportion to s, their jumps, until the motion is back in the mode in which it was touching.
struct ContactChain {
    bool ends = false;                 ///< the first contact ends the motion
    std::string reason;                ///< why it does not come back at once; empty if it does
    Eigen::VectorXd gain;              ///< of the states against the motion without contact at the same time, by s
    double time = 0;                   ///< from the first contact to the return, by s
    double restitution = 0;            ///< rate of the touched function after the first jump, by s
    std::vector<std::size_t> contacts; ///< transitions that are made
    std::vector<std::size_t> modes;    ///< that they lead to: the last is the one of the touch
    bool only_changes_modes = true;    ///< no jump changes a state
    bool leaves_by_surface = true;     ///< every contact but the first is at the touched surface
};
ContactChain follow_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                            const TouchSizes& sizes);

} // namespace graze
