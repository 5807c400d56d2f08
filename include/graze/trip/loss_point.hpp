#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/grazing/cycle_map.hpp"
#include "graze/grazing/verdict.hpp"
#include "graze/trip/fold_passage.hpp"

#include <optional>
#include <string>
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

/// A point of a branch beyond which the stable motion is lost: a touch whose contacts grow, or a fold.
struct LossPoint {
    System system;
    Orbit orbit;           ///< orbit at the touch or fold
    ParameterId parameter; ///< parameter that moves the orbit through the point
    std::string name;      ///< name of the parameter
    std::string unit;
    double value = 0;                  ///< value of the parameter at the point
    int side = 0;                      ///< side on which the motion is lost: 1 above, -1 below
    double cycle = 0;                  ///< duration of a cycle
    double level = 0;                  ///< for a touch: approach speed up to which the map of the cycle is valid
    CycleMap map{};                    ///< for a touch: map of the cycle
    Verdict verdict{};                 ///< for a touch: its verdict
    std::optional<FoldPassage> fold{}; ///< set for a fold; empty for a touch

    const Model& model() const { return system.model(); }
    const char* kind() const { return fold ? "fold" : "touch"; }
};

/// @param point a touch, a fold, or a point of a curve of either
/// @param candidates parameters; the first that moves the orbit is used
/// @param orbit name of the orbit in messages
/// @throws InputError if the point is neither a touch nor a fold, if none of the parameters moves the orbit, or
/// if the motion is not lost there
LossPoint loss_point(const System& system, const SpecialPoint& point, const std::vector<ParameterId>& candidates,
                     std::string_view orbit = "the orbit");

/// The unit of the rate at which its parameter changes; empty if neither the parameter nor the time has a unit.
std::string unit_of_rate(const LossPoint& point);

} // namespace graze
