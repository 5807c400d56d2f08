#pragma once

#include "graze/trip/predicted_trip.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace graze {

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

/// Simulates the model from any state until the end of a trip, or as many cycles as the options allow. Any hard contact
/// may have the speed that ends it: it is no matter of one touched surface.
/// @param cycle time of one
/// @throws InputError for numbers that do not fit
TripTime simulate_until(const System& system, std::span<const double> parameters, std::span<const double> state,
                        std::size_t mode, double cycle, const TripEnd& end, const TripOptions& options);

} // namespace graze
