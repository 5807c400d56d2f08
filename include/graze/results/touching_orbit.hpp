#pragma once

#include "graze/results/stored_orbit.hpp"
#include "graze/trip/loss_point.hpp"

#include <string>
#include <vector>

namespace graze {

/// Parameters that can be varied to move an orbit of a run off its contact: the named one, or those that the run
/// follows. On a curve the freed parameter comes first, since the followed one may have no effect on the touching
/// orbit, for example the stiffness of the stop that it touches.
/// @param asked name of a parameter, or empty @param place where the user named it, for messages
/// @throws InputError for a name that is no parameter
std::vector<ParameterId> moving_parameters(const StoredRun& run, const std::string& asked, const Place& place);

/// A touching orbit of a result file, with the map near it.
struct TouchingOrbit : TouchingMap {
    StoredOrbit stored;
};
/// @param point name of the orbit, see find_stored_orbit; @param parameter name of the parameter that moves the orbit,
/// or empty: the one that its run follows
/// @param point_place, parameter_place where the user named them, for messages
/// @throws InputError if there is no such point or parameter, or the orbit does not touch
TouchingOrbit find_touching_orbit(const ResultFile& file, const std::string& point, const std::string& parameter,
                                  const Place& point_place, const Place& parameter_place);

/// The loss point of a stored orbit. @throws InputError as find_touching_orbit and the loss_point of an orbit do
LossPoint loss_point(const StoredOrbit& stored, const std::string& parameter, const Place& point_place,
                     const Place& parameter_place);

} // namespace graze
