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
    std::string end;                         ///< label of the transition or name of the section that ends it
    std::vector<double> times;               ///< since the start of the orbit
    std::vector<std::vector<double>> states; ///< at these times; cyclic states are within one period of them
    std::string problem;                     ///< why the motion stops before the end of the segment; empty: it does not
};

/// The motion along the segments of an orbit as they are given. Events within a segment are ignored, so that unphysical
/// orbits are shown too. The motion stops after 100,000 integration steps; `problem` then says so.
/// @param samples approximate number of times in one period; both ends of each segment are always included
std::vector<SegmentMotion> orbit_motion(const Model& model, const Orbit& orbit, std::size_t samples);

/// The model with the parameter values of an orbit.
Model model_at(const Model& model, const Orbit& orbit);

} // namespace graze
