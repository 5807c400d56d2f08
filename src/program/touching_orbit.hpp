#pragma once

#include "graze/grazing/cycle_map.hpp"
#include "graze/results/stored_orbit.hpp"

#include <optional>
#include <string>
#include <vector>

namespace graze {

/// An orbit of a file that touches, with the map of its cycle.
struct TouchingOrbit {
    StoredOrbit stored;
    std::optional<ParameterId> parameter; ///< that moves it from its touch
    CycleMap map;                         ///< with respect to that
};

/// @param point as users name it; @param parameter what they want to move, or empty: what its run follows
/// @throws InputError when there is no such point, parameter, or touch
TouchingOrbit find_touching_orbit(const ResultFile& file, const std::string& point, const std::string& parameter);

/// The same of an orbit that has been found.
TouchingOrbit touching_orbit(StoredOrbit stored, const std::string& parameter);

/// What may move an orbit of a run: what was asked for, or what the run follows. On a curve that is first the one that
/// has been freed, since its own may have nothing to do with the orbit, as the stiffness of a stop has not.
std::vector<ParameterId> moving_parameters(const StoredRun& run, const std::string& asked);

} // namespace graze
