#pragma once

#include "graze/branch/located_value.hpp"
#include "graze/results/stored_orbit.hpp"

#include <string>

namespace graze {

/// A point of a result file whose parameter value is a function of the other parameters.
struct LocatedPoint {
    StoredOrbit stored;
    Model model;                ///< at the point's parameters
    SpecialPoint point;         ///< as one whose condition can be held
    LocatedValue located;       ///< of the control parameter, as a function of all others
    std::string name{}, unit{}; ///< of the control parameter
};

/// @param point as users name it; @param parameter whose value is located; empty: the one that the run follows, and on
/// a
///        curve first the one that was freed
/// @throws InputError where there is no such point or parameter, nothing that could be held happens there, and where
/// the
///         value does not follow from the other parameters
LocatedPoint located_point(const ResultFile& file, const std::string& point, const std::string& parameter,
                           const Place& point_place, const Place& parameter_place);

} // namespace graze
