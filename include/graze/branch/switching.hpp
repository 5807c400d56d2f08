#pragma once

#include "graze/branch/orbit_branch.hpp"
#include "graze/branch/special_point.hpp"

#include <string>
#include <vector>

namespace graze {

/// An orbit from which another branch goes, and the direction in which it does.
struct BranchStart {
    Orbit orbit;
    OrbitDirection direction; ///< for OrbitBranch::start_along
    double distance = 0;      ///< of the first point from the orbit, for the same
    std::string how;          ///< in words: "with one more contact at 'front'", "doubled"
};

/// Where one can go on from a special point:
/// - from a flip, the orbit of twice the period; from a branch point, the other branch, both ways; where a half orbit
/// loses
///   its symmetry, the orbit without it, and its twin;
/// - from a grazing inside an arc, the orbit with one more contact. Its signature is found by following the motion that
/// the
///   model makes after a contact of small speed for one period; the start is the orbit whose new contact has that
///   speed;
/// - from a contact that has lost its speed, the orbit with one contact fewer, likewise.
/// @param settings of the branch on which the point was found: its parameter varies
/// @throws InputError for points from which nothing leads on, saying why: as when the contact accumulates
std::vector<BranchStart> branches_at(const System& system, const SpecialPoint& point, const BranchSettings& settings);

} // namespace graze
