#pragma once

#include "graze/grazing/cycle_map.hpp"
#include "grazing/local_map.hpp"
#include "grazing/touch_geometry.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>

namespace graze {

/// The derivative of an orbit's motion from a touch until it comes back there, on the surface where the touched
/// function has no rate.
struct ReturnMap {
    std::string reason; ///< why there is none; empty if there is one
    TouchState touch;
    TouchGeometry geometry;
    std::size_t piece = 0;     ///< in which it is
    double time = 0;           ///< since that one's start
    Eigen::MatrixXd matrix;    ///< states x states
    Eigen::VectorXd parameter; ///< the same with respect to a free parameter; empty without one
};

/// @param equations of the orbit, and their evaluation; @param functions of the touched event in the segment's mode
/// @param free which of the free parameters of the equations counts
ReturnMap return_map(const OrbitEquations& equations, const OrbitEvaluation& at, const OrbitTouch& touch,
                     const TouchFunctions& functions, std::optional<std::size_t> free);

/// The map of the cycle from it. @param free as above
CycleMap cycle_map_of(const OrbitEquations& equations, const OrbitEvaluation& at, const OrbitTouch& touch,
                      std::optional<std::size_t> free, AskedContacts asked = AskedContacts::all,
                      bool next_order = false);
/// The same with the touched function compiled already.
CycleMap cycle_map_of(const OrbitEquations& equations, const OrbitEvaluation& at, const OrbitTouch& touch,
                      const TouchFunctions& functions, std::optional<std::size_t> free, AskedContacts asked,
                      bool next_order = false);

} // namespace graze
