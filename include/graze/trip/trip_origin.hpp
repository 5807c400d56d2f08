#pragma once

#include "graze/trajectory/observer.hpp"
#include "graze/trip/loss_point.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace graze {

/// A stable orbit at a value of the parameter before that at which it is lost: where a disturbed motion begins.
struct TripOrigin {
    ParameterId parameter;
    double value = 0; ///< of the parameter
    double point = 0; ///< at which the orbit is lost
    double cycle = 0; ///< time of one
    /// Amid the orbit's longest arc: what changes from cycle to cycle changes there, and not together with an event.
    std::vector<double> state, parameters;
    std::size_t mode = 0;
    std::optional<std::size_t> event; ///< whose contacts' speeds may end a trip
    bool half = false;                ///< so may those of its image

    bool counts(const Contact& contact) const;
};

/// @param map of the touch at which the orbit is lost, with respect to the parameter; @param orbit that touches
/// @throws InputError where no stable orbit of the same kind is found at the value, or it lies beyond the point
TripOrigin trip_origin(const System& system, const Orbit& orbit, const CycleMap& map, ParameterId parameter,
                       double value);
/// The same before a fold.
TripOrigin trip_origin(const System& system, const FoldPassage& fold, double value);
/// The same before a touch or a fold.
TripOrigin trip_origin(const LossPoint& point, double value);

} // namespace graze
