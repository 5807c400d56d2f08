#pragma once

#include "graze/flow/system.hpp"
#include "graze/orbit/orbit.hpp"

#include <optional>

namespace graze {

/// What leads from a long periodic orbit to a homoclinic one.
struct HomoclinicCandidate {
    Orbit orbit;         ///< a first guess: from where the periodic orbit leaves the saddle to where it approaches it
    double distance = 0; ///< at which the periodic orbit passes the saddle, relative to the extent of its states
};
/// Returns the candidate for the homoclinic orbit beside a periodic orbit, from where that is slowest. Half of an orbit
/// with a symmetry leads to a candidate if the saddle is its own image. @return empty where the orbit passes no saddle
std::optional<HomoclinicCandidate> homoclinic_candidate(const System& system, const Orbit& orbit, double tolerance);

} // namespace graze
