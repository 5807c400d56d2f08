#pragma once

#include "graze/grazing/cycle_map.hpp"
#include "graze/orbit/certificate.hpp"
#include "grazing/touch_geometry.hpp"
#include "orbit/shooting.hpp"

#include <cstddef>
#include <map>
#include <optional>

namespace graze {

/// Computes cycle maps of a sequence of orbits from existing evaluations, compiling the functions of each mode once.
class TouchedOnce {
public:
    /// @param event the touched event @param certificate of the orbit of the evaluation. The first free parameter of
    /// the equations is that of the map @return empty where the orbit may have other touches or the contact is not
    /// rigid; then use `cycle_map`
    std::optional<CycleMap> map(Shooting& equations, const OrbitEvaluation& at, const Certificate& certificate,
                                std::size_t event);

private:
    std::map<std::size_t, TouchFunctions> functions_; ///< compiled functions, by mode of the touch
};

} // namespace graze
