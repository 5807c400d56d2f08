#pragma once

#include "graze/grazing/cycle_map.hpp"
#include "graze/orbit/certificate.hpp"
#include "grazing/touch_geometry.hpp"
#include "orbit/shooting.hpp"

#include <cstddef>
#include <map>
#include <optional>

namespace graze {

/// Maps of cycles of one orbit after another, from what has been evaluated of each anyway.
class TouchedOnce {
public:
    /// @param event that is touched @param certificate of the orbit at which the equations have been evaluated, whose
    ///        first free parameter is that of the map
    /// @return none where anything else may be touched too, or the contact is not a rigid one: then `cycle_map` says
    /// more
    std::optional<CycleMap> map(Shooting& equations, const OrbitEvaluation& at, const Certificate& certificate,
                                std::size_t event);

private:
    std::map<std::size_t, TouchFunctions> functions_; ///< of each mode in which it is touched
};

} // namespace graze
