#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/grazing/cycle_map.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace graze {

/// The map of the cycle of a touching orbit, with the parameter that moves the orbit from its touch.
struct TouchingMap {
    std::optional<ParameterId> parameter; ///< the first candidate that moves the orbit; otherwise the last candidate,
                                          ///< or empty without candidates
    CycleMap map;                         ///< map with respect to that parameter
};

/// @param point Computes the map. @param point a grazing, or another point whose orbit touches
/// @param candidates parameters; the first that moves the orbit is used, or the last if none does
/// @param orbit name of the orbit in messages
/// @throws InputError when the orbit touches nothing
TouchingMap touching_map(const System& system, const SpecialPoint& point, const std::vector<ParameterId>& candidates,
                         std::string_view orbit = "the orbit");

} // namespace graze
