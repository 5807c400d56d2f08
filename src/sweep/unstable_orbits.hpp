#pragma once

#include "sweep/orbit_finder.hpp"
#include "sweep/return_watcher.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// Unstable orbits found near a motion. Chaotic motions pass by the same few orbits again and again, and Newton's
/// method would find these again each time.
class UnstableOrbits {
public:
    void clear() { states_.clear(); }
    /// Adds the finder's orbit if it is unstable; the motion's returns belong to the same orbit.
    void add(const OrbitFinder& orbit, const ReturnWatcher& motion);
    /// Returns whether a recurrence of the motion is explained by its passing one of these orbits. False if the motion
    /// is within `least` of the orbit: it may stay there.
    bool explain(ReturnWatcher& motion, std::size_t period, double least) const;

private:
    std::vector<std::vector<double>> states_; ///< states at the returns of the orbits
};

} // namespace graze
