#pragma once

#include "graze/trajectory/jet_set.hpp"
#include "orbit/orbit_flow.hpp"
#include "orbit/saddle_cycle.hpp"

#include <optional>
#include <vector>

namespace graze {

/// A motion that begins in the linear unstable space of a saddle cycle, divided into segments as the cycle is.
struct ManifoldMotion {
    double beginning = 0; ///< unstable coordinate of the first start
    Orbit orbit;          ///< starts and segments; one start more than segments, the last of which is where it ends
    std::size_t segments() const { return orbit.durations.size(); }
};

/// Follows the motions by the model's own events.
class ManifoldFollower {
public:
    /// @param longest time for which motions are followed
    ManifoldFollower(const System& system, const SaddleCycle& cycle, double tolerance, double longest);
    /// Follows the motion from an unstable coordinate. It has no segments where it cannot be followed.
    ManifoldMotion follow(double beginning);
    /// True when the motion may pass the cycle's start after this number of segments: the last one ends as the cycle's
    /// last one does.
    bool may_pass(const ManifoldMotion& motion, std::size_t segments) const;

private:
    const SaddleCycle* cycle_;
    std::vector<std::size_t> sections_;
    Simulation simulation_;
    JetSet jets_;
    ModeFlow flow_;
    double longest_;
};

} // namespace graze
