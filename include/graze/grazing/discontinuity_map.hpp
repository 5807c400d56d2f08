#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A state in which a mode's motion meets the surface of an event without speed.
struct TouchState {
    std::size_t mode = 0, event = 0;
    std::vector<double> state, parameters;
    /// Sizes of the states, by which is judged what counts as zero: positive, as many as there are states.
    std::vector<double> scales;
};

/// How the motion beside a touch depends on how deep it would go.
enum class MapOrder {
    none,         ///< there is no map: `reason` says why
    square_root,  ///< a rigid contact: by the root of the depth
    three_halves, ///< a compliant contact: by its power 3/2
    linear,       ///< sliding or sticking for a moment: in proportion to it
};
/// Stable name for tables and files, such as "square-root".
std::string_view name_of(MapOrder order);

/// What a contact adds to the motion beside a touch (discontinuity map: A. B. Nordmark, J. Sound Vib. 145, 1991; M. di
/// Bernardo et al., "Piecewise-smooth Dynamical Systems", 2008, chapters 6 to 8), to leading order and in the units of
/// the model. With h the event's function, a neighbour of
/// the touch that would reach the least value h = -d < 0 if nothing happened at the surface goes on as one that at the
/// same time has gained
///
///     direction * s  with the approach speed s = sqrt(2 acceleration d)     (square_root)
///     direction * d^(3/2)                                                   (three_halves)
///     direction * d                                                         (linear)
///
/// Of a square_root map that a single jump makes the next order is known, too: the gain is direction s + second s^2,
/// with an error of s^3; and of a linear one, where it is direction d + second d^(3/2), with an error of d^2.
///
/// It follows from the symbolic model alone: derivatives of the event's function along the flow, of jumps, and of the
/// fields; a contact may lead through other modes for a time that vanishes with s.
struct DiscontinuityMap {
    MapOrder order = MapOrder::none;
    std::string reason; ///< why there is no map, in one line; empty if there is one
    bool ends = false;  ///< there is none since the first contact ends the motion
    TouchState touch;
    double acceleration = 0;           ///< second rate of the event's function at the touch: positive
    double restitution = 0;            ///< speed after the first jump by that before, as the function's rate has it
    std::vector<double> gradient;      ///< of the event's function with respect to the states
    std::vector<double> rate_gradient; ///< of its rate
    std::vector<double> field;         ///< rates of the states
    std::vector<double> direction;     ///< what the states gain
    std::vector<double> second;        ///< the next order, by s^2 or d^(3/2); empty: not known
    std::vector<std::size_t> contacts; ///< transitions of the model that are made, in their order
    double time = 0;                   ///< that they take, from touch to return, for each unit of s

    bool exists() const { return order != MapOrder::none; }
    /// What `direction` and `second` are multiplied by. @param depth d, 0 and more
    double by_depth(double depth) const;
    double second_by_depth(double depth) const;
};

/// The map at a touch.
/// @return one of order `none`, with the reason, where the contact is of another kind: the jump is not the identity at
///         zero speed, the acceleration vanishes, the motion stays in another mode, ...
/// @throws InputError for numbers that do not fit the system
DiscontinuityMap discontinuity_map(const System& system, const TouchState& touch);

} // namespace graze
