#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/grazing/verdict.hpp"
#include "graze/trip/fold_passage.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// A point of a branch beyond which the motion is lost: a touch whose contacts grow, or a fold.
struct LossPoint {
    System system;
    Orbit orbit;           ///< that touches, or folds
    ParameterId parameter; ///< that moves the orbit
    std::string name;      ///< of that
    std::string unit;
    double value = 0;  ///< of that at the point
    int side = 0;      ///< on which the motion is lost: 1 above, -1 below
    double cycle = 0;  ///< time of one
    double level = 0;  ///< of a touch: approach speed up to which the map of the cycle tells of contacts
    CycleMap map{};    ///< of a touch
    Verdict verdict{}; ///< of a touch
    std::optional<FoldPassage> fold{}; ///< none: it is a touch

    const Model& model() const { return system.model(); }
    const char* kind() const { return fold ? "fold" : "touch"; }
};

/// @param point a touch, a fold, or a point of a curve of them
/// @param candidates the first of them that moves the orbit is taken
/// @param orbit how messages name it
/// @throws InputError where nothing is touched and it is no fold, where none of the parameters moves the orbit, and
///         where the motion is not lost there
LossPoint loss_point(const System& system, const SpecialPoint& point, const std::vector<ParameterId>& candidates,
                     std::string_view orbit = "the orbit");

} // namespace graze
