#pragma once

#include "graze/model/model.hpp"
#include "graze/orbit/orbit.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// The motion along one segment of an orbit, from just after one jump to just before the next.
struct SegmentMotion {
    std::size_t mode = 0;
    std::string end;                         ///< what ends it: a transition's label, or a section's name
    std::vector<double> times;               ///< since the orbit's start
    std::vector<std::vector<double>> states; ///< at these times, cyclic ones within their periods
    std::string problem;                     ///< why it could not be followed to its end; empty when all is well
};

/// The motion along the segments of an orbit as they are given: events on the way do not happen, so that orbits which
/// the model would not follow can be shown too. Of orbits that take more than 100,000 steps the rest is left out, which
/// `problem` says.
/// @param samples about how many rows there are of a whole period; both ends of each segment are among them
std::vector<SegmentMotion> orbit_motion(const Model& model, const Orbit& orbit, std::size_t samples);

/// The model at the parameters of an orbit.
Model model_at(const Model& model, const Orbit& orbit);

} // namespace graze
