#include "graze/trip/overshoot_trip.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

const TripTime* OvershootTrip::best() const {
    if (simulated && simulated->ended)
        return &*simulated;
    if (continued && continued->ended)
        return &*continued;
    return nullptr;
}

double level_until(const LossPoint& point, const TripEnd& end) {
    return end.speed > 0 ? std::min(point.level, end.speed) : point.level;
}

OvershootTrip trip_of_touch(const System& system, const CycleMap& map, const Verdict& verdict, ParameterId parameter,
                            double overshoot, double level, const TripEnd& end, const TripOptions& options) {
    PredictionOptions prediction;
    prediction.level = level;
    prediction.disturbance = options.disturbance;
    OvershootTrip trip;
    trip.overshoot = overshoot;
    trip.predicted = predicted_trip(map, verdict, overshoot, prediction);
    trip.continued = continued_trip(system, map, parameter, overshoot, *trip.predicted, end, options);
    if (overshoot == 0 || std::abs(overshoot) >= least_overshoot(map, parameter))
        trip.simulated = simulated_trip(system, map, parameter, overshoot, end, options);
    return trip;
}

FoldTrip trip_of_fold(const System& system, const FoldPassage& fold, double overshoot, const TripEnd& end,
                      bool until_passed, const TripOptions& options) {
    FoldTrip trip{overshoot, cycles_of_passage(fold, overshoot),
                  cycles_of_passage(fold, overshoot, -fold.gate, fold.gate), std::nullopt};
    if (trip.cycles < options.cycles && std::abs(overshoot) >= least_overshoot(fold))
        trip.passage = simulated_passage(system, fold, overshoot, end, until_passed, options);
    return trip;
}

} // namespace graze
