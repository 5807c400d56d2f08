#pragma once

#include "graze/atlas/atlas_findings.hpp"
#include "graze/picture/result_picture.hpp"
#include "graze/results/stored_run.hpp"

#include <string>
#include <utility>
#include <vector>

namespace graze {

/// What pictures of an atlas show.
struct DrawnAtlas {
    StoredRun run;
    AtlasFindings findings;
    std::vector<AtlasMotion> motions{};    ///< of the sweep, in the directions that are drawn
    std::vector<std::string> directions{}; ///< of each of them
};

/// The range of a parameter; where that is a single value, a range about it.
std::pair<double, double> shown_range(const AtlasAxis& axis);
/// The branches of an atlas in one parameter, and the samples of its motions.
ResultPicture atlas_diagram(const StudyPicture& picture, const DrawnAtlas& atlas);
/// The plane of both parameters of an atlas: its attractors, curves and points.
ResultPicture atlas_plane(const StudyPicture& picture, const DrawnAtlas& atlas);

} // namespace graze
