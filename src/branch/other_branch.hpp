#pragma once

#include "graze/branch/switching.hpp"

#include <string>
#include <vector>

namespace graze {

/// An orbit gone round twice, as it becomes where its period doubles.
Orbit twice(const Orbit& orbit);

/// Both ways along the null vector of an orbit's equations that is orthogonal to a direction; without one, at a fixed
/// parameter, since orbits of the new kind appear at a turning point.
/// @param second whether the other way leads elsewhere
/// @throws InputError when there is none
std::vector<BranchStart> along_null_vector(const System& system, Orbit orbit, const BranchSettings& settings,
                                           const OrbitDirection& along, const std::string& how, bool second);

} // namespace graze
