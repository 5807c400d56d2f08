#pragma once

#include "graze/branch/switching.hpp"

#include <string>
#include <vector>

namespace graze {

/// Returns an orbit traversed twice, for the start of a period-doubled branch.
Orbit twice(const Orbit& orbit);

/// Returns the starts in both directions along the null vector of an orbit's equations that is orthogonal to `along`;
/// without one, at a fixed parameter, since a doubled or asymmetric branch has a parameter extremum there.
/// @param second true if the opposite direction leads to other orbits
/// @throws InputError when no null vector is found
std::vector<BranchStart> along_null_vector(const System& system, Orbit orbit, const BranchSettings& settings,
                                           const OrbitDirection& along, const std::string& how, bool second);

} // namespace graze
