#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A state in which the motion of a mode touches the surface of an event with zero speed.
struct TouchState {
    std::size_t mode = 0, event = 0;
    std::vector<double> state, parameters;
    /// Positive scales of the states, which decide what counts as zero; one per state.
    std::vector<double> scales;
};

/// Leading order in which the effect of a contact depends on the penetration depth that the motion would reach without
/// it.
enum class MapOrder {
    none,         ///< the map does not exist: `reason` says why
    square_root,  ///< rigid contact: square root of the depth
    three_halves, ///< compliant contact: power 3/2 of the depth
    linear,       ///< sliding or sticking for a short time: linear in the depth
    quadratic,    ///< sliding that is left for a short time: square of the depth
};
/// Returns the stable name for tables and files, such as "square-root".
std::string_view name_of(MapOrder order);

/// The effect of a contact on motions near a touch (discontinuity map: A. B. Nordmark, J. Sound Vib. 145, 1991; M. di
/// Bernardo et al., "Piecewise-smooth Dynamical Systems", 2008, chapters 6 to 8), to leading order and in the units of
/// the model. With h the event function, a nearby motion that without contact would reach the minimum h = -d < 0
/// continues after the contact like the motion without contact whose state is shifted, at the time of the minimum, by
///
///     direction * s  with the approach speed s = sqrt(2 acceleration d)     (square_root)
///     direction * d^(3/2)                                                   (three_halves)
///     direction * d                                                         (linear)
///     direction * d^2                                                       (quadratic)
///
/// The next order is known for a square_root map with a single jump, where the shift is direction s + second s^2 with
/// an error of order s^3, and for a linear map, where it is direction d + second d^(3/2) with an error of order d^2.
///
/// The map is computed from the symbolic model: derivatives of the event function along the flow, of jumps and of
/// vector fields. A contact may lead through other modes for a time that vanishes with s.
struct DiscontinuityMap {
    MapOrder order = MapOrder::none;
    std::string reason; ///< why the map does not exist, in one line; empty if it does
    bool ends = false;  ///< the map does not exist because the first contact ends the motion
    TouchState touch;
    double acceleration = 0; ///< second time derivative of the event function at the touch: positive
    /// Ratio of the rates of the event function after and before the first jump, with opposite sign.
    double restitution = 0;
    std::vector<double> gradient;      ///< gradient of the event function with respect to the states
    std::vector<double> rate_gradient; ///< gradient of the rate of the event function
    std::vector<double> field;         ///< vector field at the touch
    std::vector<double> direction;     ///< leading-order shift of the states
    std::vector<double> second;        ///< next-order coefficient, of s^2 or d^(3/2); empty: unknown
    std::vector<std::size_t> contacts; ///< transitions of the model that the contact makes, in order
    double time = 0;                   ///< duration of the contact until the return to the first mode, per unit of s

    bool exists() const { return order != MapOrder::none; }
    /// Return the factors of `direction` and `second` at a depth d >= 0.
    double by_depth(double depth) const;
    double second_by_depth(double depth) const;
};

/// Computes the discontinuity map at a touch.
/// @return a map of order `none`, with the reason, where the contact is of another kind: the jump is not the identity
/// at
///         zero speed, the acceleration vanishes, the motion stays in another mode, ...
/// @throws InputError for numbers that do not fit the system
DiscontinuityMap discontinuity_map(const System& system, const TouchState& touch);

} // namespace graze
