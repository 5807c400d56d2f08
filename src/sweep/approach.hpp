#pragma once

#include "sweep/orbit_finder.hpp"
#include "sweep/return_watcher.hpp"

#include <cstddef>
#include <span>
#include <vector>

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
