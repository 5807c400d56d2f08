#pragma once

#include "sweep/orbit_finder.hpp"
#include "sweep/return_watcher.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Tests whether a motion close to a stable orbit stays with it. Being close once is not enough: where deviations
/// rotate about the orbit while they shrink, a contact that the orbit does not have may follow many returns later, and
/// chaotic motions pass by orbits by chance. The motion is followed until the rotating deviations have shrunk to a
/// tenth, so that it has passed all directions in which it could leave; and for twice the longest time it has been
/// without a contact that the orbit lacks.
class OrbitStay {
public:
    enum class Verdict { staying, stayed, left };

    /// Starts the test, at a return at which `approaches` is true.
    /// @param events whether the motion can have contacts at all
    void begin(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods, bool events);
    /// To be called at each later return, or at once.
    Verdict judge(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods) const;
    /// Returns the number of returns that the test takes.
    std::size_t needed() const { return needed_; }
    /// Returns the number of returns since the test began.
    std::size_t gone(const ReturnWatcher& motion) const { return motion.returns() - first_; }

private:
    std::size_t first_ = 0, needed_ = 0;
    double size_ = 0;           ///< size of the deviation at the beginning
    std::vector<double> scale_; ///< of the states at the beginning (the extents of a shrinking motion shrink too)
};

/// Returns the largest modulus of the multipliers except a real leading one: along its direction the motion approaches
/// monotonically and meets nothing new. 0 if there is no other.
double turning_radius(const OrbitFinder& orbit);

} // namespace graze
