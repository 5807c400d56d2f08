#include "sweep/unstable_orbits.hpp"

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Factor of the distance at which a motion recurs: within this distance of an unstable orbit, the recurrence is
/// explained by it. Another, stable orbit is farther away once the motion is close enough to it.
constexpr double near = 3;

} // namespace

void UnstableOrbits::add(const OrbitFinder& orbit, const ReturnWatcher& motion) {
    const bool unstable = !orbit.multipliers().empty() && std::abs(orbit.multipliers().front()) > 1;
    if (orbit.found() && unstable) {
        states_.insert(states_.end(), orbit.returns().begin(), orbit.returns().end());
    } else if (orbit.clearly_unstable()) {
        states_.emplace_back(orbit.point().begin(), orbit.point().end());
        // The motion was about as close to the orbit at its other returns.
        for (std::size_t k = 1; k < std::min(orbit.period(), motion.remembered()); ++k)
            states_.push_back(motion.recent(k).state);
    }
}

bool UnstableOrbits::explain(ReturnWatcher& motion, std::size_t period, double least) const {
    const std::vector<double>& here = motion.recent(0).state;
    const double most = near * motion.distance(here, motion.recent(period).state);
    return std::ranges::any_of(states_, [&](const std::vector<double>& state) {
        const double distance = motion.distance(here, state);
        return distance > least && distance <= most;
    });
}

} // namespace graze
