#pragma once

#include "graze/trip/predicted_trip.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace graze {

struct TripOptions {
    double cycles = 2000;                ///< largest number of simulated cycles; raise it for slow trips
    double tolerance = 1e-14;            ///< relative tolerance of the integration, 1e-16 .. 1e-2
    std::size_t step_limit = 20'000'000; ///< largest number of integration steps
    std::vector<double> disturbance;     ///< initial disturbance of each state; empty: none
    std::function<bool()> interrupted;   ///< called at each step; returns true to stop
    /// @throws InputError naming the option that is out of range
    void validate() const;
};

/// Returns the smallest overshoot that a simulation can resolve in double precision.
double least_overshoot(const CycleMap& map, ParameterId parameter);

/// Simulates a trip from the state of the touch, with the parameter moved. The simulation starts slightly earlier if
/// the start would lie beyond the surface.
/// @param map with respect to the parameter
/// @throws InputError for arguments that do not fit the map
TripTime simulated_trip(const System& system, const CycleMap& map, ParameterId parameter, double overshoot,
                        const TripEnd& end, const TripOptions& options = {});

/// Continues a predicted trip by simulation once contacts can be resolved: gives the time until any end, also for
/// overshoots far below double precision.
TripTime continued_trip(const System& system, const CycleMap& map, ParameterId parameter, double overshoot,
                        const PredictedTrip& predicted, const TripEnd& end, const TripOptions& options = {});

/// Simulates the model from any state until the end of a trip, or for the cycles that the options allow. Contacts at
/// all surfaces count for the speed that ends it.
/// @param cycle duration of a cycle
/// @throws InputError for numbers that do not fit
TripTime simulate_until(const System& system, std::span<const double> parameters, std::span<const double> state,
                        std::size_t mode, double cycle, const TripEnd& end, const TripOptions& options);

} // namespace graze
