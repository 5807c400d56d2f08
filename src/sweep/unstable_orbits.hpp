#pragma once

#include "sweep/orbit_finder.hpp"
#include "sweep/return_watcher.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Unstable orbits that were found near a motion. Chaotic ones pass by the same few again and again: Newton's method
/// would only find these anew.
class UnstableOrbits {
public:
    void clear() { states_.clear(); }
    /// Notes what the finder has met, if that is unstable, from returns of this motion on.
    void add(const OrbitFinder& orbit, const ReturnWatcher& motion);
    /// Whether a motion that comes back after so many returns does so because it passes by one of these orbits. Not
    /// where it is within `least` of it: there it may stay.
    bool explain(ReturnWatcher& motion, std::size_t period, double least) const;

private:
    std::vector<std::vector<double>> states_; ///< at their returns
};

} // namespace graze
