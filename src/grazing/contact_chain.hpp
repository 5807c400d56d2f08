#pragma once

#include "grazing/touch_geometry.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// The sequence of transitions after a contact of vanishing approach speed s, to first order in s: the jump, further
/// modes whose durations are proportional to s, their jumps, until the motion is back in the touching mode.
struct ContactChain {
    bool ends = false;      ///< the first contact ends the motion
    std::string reason;     ///< why the motion does not return in a time proportional to s; empty if it does
    Eigen::VectorXd gain;   ///< shift of the states against the motion without contact at the same time, per unit of s
    double time = 0;        ///< time from the first contact to the return, per unit of s
    double restitution = 0; ///< rate of the touched function after the first jump, per unit of s
    std::vector<std::size_t> contacts; ///< transitions made
    std::vector<std::size_t> modes;    ///< modes after them; the last is the touching mode
    bool only_changes_modes = true;    ///< no jump changes the states
    bool leaves_by_surface = true;     ///< every contact after the first happens at the touched surface
};
/// Follows the transitions that a contact at a touch starts.
ContactChain follow_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                            const TouchSizes& sizes);

} // namespace graze
