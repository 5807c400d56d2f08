#pragma once

#include "graze/grazing/cycle_map.hpp"
#include "graze/results/stored_orbit.hpp"

#include <optional>
#include <string>

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

} // namespace graze
