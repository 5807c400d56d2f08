#pragma once

#include "sweep/orbit_finder.hpp"
#include "sweep/return_watcher.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Whether a motion that comes close to a stable orbit stays with it. To be close once is not enough: where deviations
/// turn about the orbit while they shrink, a contact that the orbit does not have may follow many returns later, and a
/// chaotic motion passes by orbits by chance. The motion is followed until what turns has shrunk to a tenth, so that it
/// has shown itself in all directions from which it may leave; and twice as long as it has ever been without a contact
/// that the orbit does not have.
class OrbitStay {
public:
    enum class Verdict { staying, stayed, left };

    /// The motion is where `approaches` said so, at a return.
    /// @param events whether anything can happen to the motion
    void begin(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods, bool events);
    /// To be called at each return from the next on, or at once.
    Verdict look(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods) const;
    /// Returns of which it begins, and that it takes.
    std::size_t needed() const { return needed_; }
    /// Returns since it began.
    std::size_t gone(const ReturnWatcher& motion) const { return motion.returns() - first_; }

private:
    std::size_t first_ = 0, needed_ = 0;
    double size_ = 0;           ///< of the deviation at the beginning
    std::vector<double> scale_; ///< of the states at the beginning: where all of a motion shrinks, its extents do too
};

/// Largest modulus of the multipliers, but of a leading one that is real: along that direction the motion comes closer
/// and closer, and what it meets there it has met. 0 if there is no other.
double turning_radius(const OrbitFinder& orbit);

} // namespace graze
