#pragma once

#include "graze/grazing/map_motion.hpp"
#include "graze/grazing/trial.hpp"
#include "graze/grazing/verdict.hpp"

#include <optional>
#include <vector>

namespace graze {

/// What the map of a cycle settles on at a distance beyond the touch.
struct MotionBeyond {
    int digits = 0;       ///< the clearance is 10^-digits of the orbit's size
    double parameter = 0; ///< its value there
    MapMotion motion;
};

/// What becomes of an orbit beyond its touch.
struct TouchReport {
    Verdict verdict;
    std::vector<MotionBeyond> beyond; ///< of square_root maps whose attractors persist
    std::optional<Trial> trial;       ///< the verdict, checked by simulation
};

/// @param map of the touch, with respect to the parameter; @param parameter that moves the orbit from the touch; none:
///        nothing is told of the motion beyond it
/// @param verify whether the verdict is checked by simulation
/// @throws InputError where it is to be checked and no parameter is given
TouchReport touch_report(const System& system, const CycleMap& map, std::optional<ParameterId> parameter, bool verify);

} // namespace graze
