#pragma once

#include "graze/grazing/verdict.hpp"
#include "graze/trip/trip_time.hpp"

#include <cstddef>
#include <vector>

namespace graze {

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

} // namespace graze
