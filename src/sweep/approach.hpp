#pragma once

#include "sweep/orbit_finder.hpp"
#include "sweep/return_watcher.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Whether the motion is seen to approach the stable orbit that was found: either the distance has become, from one
/// period to the next, what the multipliers say; or it has shrunk period after period along the slowest direction, at
/// least half as fast as on the orbit itself. That excludes orbits which Newton's method found further away.
/// @param tolerance of the integration
bool approaches(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods,
                double tolerance);

/// Whether the motion is so close to the orbit that was found, and that so nearly linear about it, that a stable one
/// leaves no room for anything else.
bool is_near(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods);

/// Whether the motion comes closer to the orbit that was found from period to period, by less each time.
bool creeps_towards(const OrbitFinder& orbit, ReturnWatcher& motion, std::span<const double> periods);

/// Distance of the motion's last return from the orbit that was found, relative to the scales of the states.
double distance_from(const OrbitFinder& orbit, const ReturnWatcher& motion, std::span<const double> periods,
                     std::span<const double> scale);

/// Whether the same things have happened in each of the last periods as along the orbit.
bool same_contacts(const OrbitFinder& orbit, const ReturnWatcher& motion, std::size_t periods);

/// Where to look for the orbit that a motion comes to only slowly.
struct Guess {
    std::size_t period = 0; ///< in returns
    std::vector<double> state;
};
/// In the middle of the last returns, one period apart.
Guess middle_of(const ReturnWatcher& motion, const SectionMap& map, std::size_t period,
                std::span<const double> periods);
/// Where the motion is, if it moves on by less with every period; in the middle of where it has been, if it turns about
/// that and comes closer.
/// @param largest period that is looked for
std::vector<Guess> slow_limits(ReturnWatcher& motion, const SectionMap& map, std::size_t largest,
                               std::span<const double> periods);

} // namespace graze
