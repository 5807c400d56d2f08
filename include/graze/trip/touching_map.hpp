#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/grazing/cycle_map.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace graze {

/// The map of the cycle of an orbit that touches, with the parameter that moves it from its touch.
struct TouchingMap {
    std::optional<ParameterId> parameter; ///< none of the candidates: the last that was tried, or none at all
    CycleMap map;                         ///< with respect to that
};

/// @param point a grazing, or another orbit that touches
/// @param candidates the first of them that moves the orbit is taken; if none does, the last
/// @param orbit how messages name it
/// @throws InputError where nothing is touched
TouchingMap touching_map(const System& system, const SpecialPoint& point, const std::vector<ParameterId>& candidates,
                         std::string_view orbit = "the orbit");

} // namespace graze
