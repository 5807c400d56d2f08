#pragma once

#include "grazing/touch_geometry.hpp"

#include <optional>
#include <span>
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
    /// Event of the surface along which the touching mode slides, if that is left for a time that is short as well, but
    /// is not determined by the gain.
    std::optional<std::size_t> slid_along;
};
/// Follows the transitions that a contact at a touch starts.
ContactChain follow_contact(const TouchFunctions& functions, const TouchState& touch, const TouchGeometry& geometry,
                            const TouchSizes& sizes);

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

/// True when a jump leaves all states of a surface near the touch unchanged, to first order.
/// @param geometry of the surface's function
bool is_identity_on_surface(const System& system, std::size_t jump, const TouchState& touch,
                            const TouchGeometry& geometry, const TouchSizes& sizes);

/// Returns the s^2 coefficient of the shift of the states at a touch with a single jump: the next order of the
/// square-root map. @param transition of the touching mode that returns to the same mode
/// @return empty where derivatives of the model are not finite
std::optional<Eigen::VectorXd> next_order_of_impact(const TouchFunctions& functions, const TouchState& touch,
                                                    const TouchGeometry& geometry, const TouchSizes& sizes,
                                                    std::size_t transition);

} // namespace graze
