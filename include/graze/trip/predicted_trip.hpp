#pragma once

#include "graze/grazing/verdict.hpp"
#include "graze/trip/trip_time.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// A trip predicted by the map. Cycles count passes of the touch; the start is number 0.
struct PredictedTrip : TripTime {
    double level = 0;        ///< approach speed at which the trip ends
    double first_cycles = 0; ///< cycles until the first contact
    double first_speed = 0;  ///< its approach speed
    /// The pass from which `continued_trip` simulates: that of the first contact that a simulation can resolve (0 if
    /// that is the very first), with the deviation of the active states from the orbit without contact there.
    double handed_cycles = 0;
    std::size_t handed_contacts = 0; ///< contacts before it
    std::vector<double> handed;
};

struct PredictionOptions {
    double level = 0;                ///< approach speed at which the trip ends; 0: level_of_map
    std::vector<double> disturbance; ///< initial disturbance of each state of the model; empty: none
    std::size_t contacts = 10'000;   ///< largest number of contacts
};

/// Returns ten overshoots: 1e-2, 1e-4 ... 1e-20 times the power of ten of the parameter's value.
/// @param side sign of the overshoots
std::vector<double> usual_overshoots(double value, int side);

/// Returns an approach speed up to which the map of a lost orbit is valid: a tenth of the speed to which its contacts
/// grow, and of the largest speed that the extents of the states allow. For sliding only the latter applies, because
/// the reach of the growth is unknown.
/// @throws InputError unless the verdict is `lost`
double level_of_map(const CycleMap& map, const Verdict& verdict);

/// Predicts cycles and time until an approach speed by the map alone, for any overshoot, however small: the decay of
/// the initial state until the first contact, and the growth from contact to contact. The time is that of whole cycles
/// minus speed / acceleration, which is also its accuracy. Cycles without contact are iterated one by one up to a
/// hundred thousand in a row, then by powers of the map, since the state then decays monotonically with multipliers
/// near 1. For a half orbit, cycles are half periods. @param overshoot signed distance of the parameter from its value
/// at the touch; 0 where a disturbance starts the trip @return a trip that has not ended where contacts do not grow to
/// the level ("none"), as when it is beyond their reach, and where the first contact is already outside the validity of
/// the map ("too-far") @throws InputError unless the verdict is `lost`; for a map without a parameter, an overshoot on
/// the side without contacts, and numbers that do not fit or are not finite
PredictedTrip predicted_trip(const CycleMap& map, const Verdict& verdict, double overshoot,
                             const PredictionOptions& options = {});

} // namespace graze
