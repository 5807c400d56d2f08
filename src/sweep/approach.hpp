#pragma once

#include "sweep/orbit_finder.hpp"

namespace graze {

/// Returns whether the motion demonstrably approaches the stable orbit that was found: either the deviation changes
/// from one period to the next as the linear part says; or it has shrunk period after period along the slowest
/// direction, at least half as fast as the multiplier says. This excludes orbits that Newton's method found farther
/// away.
/// @param tolerance of the integration
bool approaches(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods,
                double tolerance);

/// Returns whether the motion is so close to the orbit that was found, and so nearly linear about it, that it must
/// converge to the orbit if that is stable.
bool is_near(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods);

/// Returns whether the motion comes closer to the orbit from period to period, by less each time.
bool approaches_slowly(const OrbitFinder& orbit, ReturnWatcher& motion, std::span<const double> periods);

/// Returns the distance of the motion's last return from the orbit, relative to the scales of the states.
double distance_from(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods,
                     std::span<const double> scale);

/// Returns whether the contacts in each of the last periods are those of the orbit.
bool same_contacts(const OrbitFinder& orbit, const ReturnWatcher& motion, std::size_t periods);

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

/// A starting point of Newton's method for the orbit that a motion approaches slowly.
struct Guess {
    std::size_t period = 0; ///< in returns
    std::vector<double> state;
};
/// Returns the weighted mean of the last returns, one period apart.
Guess middle_of(const ReturnWatcher& motion, const SectionMap& map, std::size_t period,
                std::span<const double> periods);
/// Returns starting points for the limits of a slow motion: its present state, if it advances by less with every
/// period; the mean of its returns, if it turns about that and comes closer.
/// @param largest longest period that is considered
std::vector<Guess> slow_limits(ReturnWatcher& motion, const SectionMap& map, std::size_t largest,
                               std::span<const double> periods);

} // namespace graze
