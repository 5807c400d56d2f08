#pragma once

#include "graze/grazing/verdict.hpp"
#include "graze/symbolic/expression.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// How long a motion takes that begins where the orbit touches, with the parameter moved beyond.
struct TripTime {
    bool ended = false; ///< the end that was asked for has come, or one of the motion's own
    std::string ending; ///< "speed", "level", or as trajectories end: "singular", "terminal", ...
    double cycles = 0;  ///< until then: passes of the touch by the map, time over that of a cycle by simulation
    double time = 0;
    std::size_t contacts = 0; ///< with the touched surface until then, that at the end included
    double speed = 0;         ///< approach speed of the last of these
    std::string detail{};     ///< of a simulation that could not go on: what happened and what to do
};

/// A trip as the map has it. Cycles are passes of the touch, of which the beginning is number 0.
struct PredictedTrip : TripTime {
    double level = 0;        ///< approach speed at which it ends
    double first_cycles = 0; ///< until the first contact
    double first_speed = 0;  ///< of that
    /// The pass from which on `continued_trip` simulates, and the distance there from the orbit without contact, of the
    /// map's active states: that of the first contact which a simulation can tell from none; 0 if it is the first of
    /// all.
    double handed_cycles = 0;
    std::size_t handed_contacts = 0; ///< made before
    std::vector<double> handed;
};

struct PredictionOptions {
    double level = 0;                ///< approach speed at which it ends; 0: level_of_map
    std::vector<double> disturbance; ///< of each state of the model where the motion begins; empty: none
    std::size_t contacts = 10'000;   ///< at most
};

/// Overshoots over ten decades: 1e-2, 1e-4 ... 1e-20 times the power of ten of the parameter's value.
/// @param side on which they are: negative below the value
std::vector<double> usual_overshoots(double value, int side);

/// An approach speed up to which the map of a lost orbit says what happens: a tenth of what its contacts grow to, and
/// of the speed with which the states of the orbit could meet the surface at all. Of sliding only the latter: it grows
/// in proportion, and nothing tells how far.
/// @throws InputError unless the verdict is `lost`
double level_of_map(const CycleMap& map, const Verdict& verdict);

/// Cycles and time until an approach speed, by the map alone, however small the overshoot is: what the state's memory
/// of the touch leaves of the clearance, the first contact as soon as it is used up, and the growth from contact to
/// contact. Time is that of whole cycles less speed / acceleration; contacts after the first are earlier or later by as
/// much.
///
/// Cycles without contact are passed one by one up to a hundred thousand in a row, and from then on by powers of the
/// map, where what is left of the state falls by multipliers next to 1 without further turns.
/// Where an orbit is given by its half, its halves are the cycles.
/// @param overshoot of the parameter beyond its value at the touch, with its sign; 0 where a disturbance sets it off
/// @return one that has not ended where contacts do not grow to the level ("none"), as when it is beyond their reach,
///         and where the first is harder than all that the map can tell of ("too-far")
/// @throws InputError unless the verdict is `lost`; for a map without parameter, an overshoot on the side on which
///         there is no contact, and numbers that do not fit or are not finite
PredictedTrip predicted_trip(const CycleMap& map, const Verdict& verdict, double overshoot,
                             const PredictionOptions& options = {});

/// What ends a simulation, besides the motion's own end (a singular one, a transition to the end).
struct TripEnd {
    double speed = 0;                   ///< approach speed at the touched surface; 0: any
    std::optional<Expression> quantity; ///< its level, passed in either direction
    double level = 0;
};

struct TripOptions {
    double cycles = 2000;     ///< that are simulated at most
    double tolerance = 1e-14; ///< of the integration; 1e-16 .. 1e-2
    std::size_t step_limit = 20'000'000;
    std::vector<double> disturbance; ///< of each state where the motion begins; empty: none
    std::function<bool()> interrupted;
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// The least overshoot that a simulation can tell from none: the parameter and the states are numbers of sixteen
/// digits.
double least_overshoot(const CycleMap& map, ParameterId parameter);

/// The same by simulation of the model from the state of the touch, with the parameter moved. The motion begins a
/// little earlier where it would begin beyond the surface.
/// @param map with respect to the parameter
/// @throws InputError as above
TripTime simulated_trip(const System& system, const CycleMap& map, ParameterId parameter, double overshoot,
                        const TripEnd& end, const TripOptions& options = {});

/// By the map as long as contacts are soft, and by simulation from then on: the time until any end, also after an
/// overshoot far below the digits of the parameter.
TripTime continued_trip(const System& system, const CycleMap& map, ParameterId parameter, double overshoot,
                        const PredictedTrip& predicted, const TripEnd& end, const TripOptions& options = {});

} // namespace graze
