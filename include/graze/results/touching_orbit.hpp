#pragma once

#include "graze/results/stored_orbit.hpp"
#include "graze/trip/loss_point.hpp"
#include "graze/trip/touching_map.hpp"

#include <string>
#include <vector>

namespace graze {

/// What may move an orbit of a run: what was asked for, or what the run follows. On a curve that is first the one that
/// has been freed, since its own may have nothing to do with the orbit, as the stiffness of a stop has not.
/// @param asked name of a parameter, or empty @param place for messages
/// @throws InputError for another name
std::vector<ParameterId> moving_parameters(const StoredRun& run, const std::string& asked, const Place& place);

/// An orbit of a file that touches, with the map of its cycle.
struct TouchingOrbit : TouchingMap {
    StoredOrbit stored;
};
/// @param point as users name it; @param parameter what they want to move, or empty: what its run follows
/// @param point_place, parameter_place for messages
/// @throws InputError when there is no such point, parameter, or touch
TouchingOrbit find_touching_orbit(const ResultFile& file, const std::string& point, const std::string& parameter,
                                  const Place& point_place, const Place& parameter_place);

/// The point at which the motion of an orbit of a file is lost.
/// @throws InputError as above, and as the loss_point of an orbit does
LossPoint loss_point(const StoredOrbit& stored, const std::string& parameter, const Place& point_place,
                     const Place& parameter_place);

} // namespace graze
