#pragma once

#include "graze/trajectory/observer.hpp"
#include "graze/trip/loss_point.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// The start of a disturbed motion: a state on a stable orbit, at a parameter value before the loss point.
struct TripOrigin {
    ParameterId parameter;
    double value = 0; ///< value of the parameter
    double point = 0; ///< value at which the orbit is lost
    double cycle = 0; ///< duration of a cycle
    /// State in the middle of the orbit's longest arc, so that changes from cycle to cycle do not coincide with an
    /// event.
    std::vector<double> state, parameters;
    std::size_t mode = 0;
    std::optional<std::size_t> event; ///< event whose contacts count for the end of a trip
    bool half = false;                ///< contacts of the event's image count too

    /// True when the speed of a contact may end a trip.
    bool counts(const Contact& contact) const;
};

/// @param map of the touch at which the orbit is lost, with respect to the parameter; @param orbit the touching orbit
/// @throws InputError if no stable orbit of the same kind is found at the value, or the value lies beyond the point
TripOrigin trip_origin(const System& system, const Orbit& orbit, const CycleMap& map, ParameterId parameter,
                       double value);
/// The same for a fold.
TripOrigin trip_origin(const System& system, const FoldPassage& fold, double value);
/// The same for a touch or a fold.
TripOrigin trip_origin(const LossPoint& point, double value);

} // namespace graze
