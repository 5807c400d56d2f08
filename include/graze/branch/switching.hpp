#pragma once

#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/special_point.hpp"

#include <string>
#include <vector>

namespace graze {

/// The start of another branch: an orbit and the direction of the branch there.
struct BranchStart {
    Orbit orbit;
    OrbitDirection direction; ///< for OrbitBranch::start_along
    double distance = 0;      ///< distance of the first point from the orbit, for OrbitBranch::start_along
    std::string how;          ///< description in words: "with one more contact at 'front'", "doubled"
};

/// Returns the branches that leave a special point: - from a flip, the orbit of twice the period; from a branch point,
/// the other branch in both directions; from a symmetry breaking, the asymmetric orbit and its symmetric image; - from
/// a grazing inside an arc, the orbit with one more contact. Its signature is found by following the motion after a
/// contact of small speed for one period; the start is the orbit whose new contact has that speed; - from a contact of
/// zero speed, the orbit with one contact fewer, found likewise.
/// @param settings of the branch on which the point was found
/// @throws InputError for points from which no branch leaves, saying why, for example because contacts accumulate
std::vector<BranchStart> branches_at(const System& system, const SpecialPoint& point, const BranchSettings& settings);

} // namespace graze
