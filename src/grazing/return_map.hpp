#pragma once

#include "graze/grazing/cycle_map.hpp"
#include "grazing/touch_geometry.hpp"
#include "orbit/orbit_equations.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>

namespace graze {

/// The contacts for which a map is computed. Compliant contacts and next orders are expensive: they need second
/// derivatives of the vector fields.
enum class AskedContacts {
    all,
    rigid,
    rigid_beside, ///< rigid contacts; the touch may be slightly off the surface and is first projected onto it
};

/// Computes `discontinuity_map` with the touched function already compiled.
DiscontinuityMap local_map(const TouchFunctions& functions, const TouchState& touch, AskedContacts asked);

/// The derivative of the return of an orbit from a touch to itself, on the surface where the touched function has zero
/// rate.
struct ReturnMap {
    std::string reason; ///< why the map does not exist; empty if it does
    TouchState touch;
    TouchGeometry geometry;
    std::size_t piece = 0;     ///< piece that contains the touch
    double time = 0;           ///< time of the touch since the start of the piece
    Eigen::MatrixXd matrix;    ///< derivative, states x states
    Eigen::VectorXd parameter; ///< derivative with respect to the free parameter; empty without one
};

/// @param equations of the orbit; @param at their evaluation; @param functions of the touched event in the segment's
/// mode
/// @param free index, among the free parameters of the equations, of the one to differentiate by
ReturnMap return_map(const OrbitEquations& equations, const OrbitEvaluation& at, const OrbitTouch& touch,
                     const TouchFunctions& functions, std::optional<std::size_t> free);

/// The shift of a motion after one cycle, to second order in s.
struct SecondGain {
    Eigen::VectorXd first,
        second;       ///< coefficients of the states, on the surface where the touched function has zero rate
    double value = 0; ///< coefficient of s^2 of the touched function
};

/// Propagates the shift first s + second s^2 of a touch around the orbit by second derivatives of flows, events and
/// jumps. @param back return map of the touch, which lies inside its arc
/// @return empty where a derivative is not finite
std::optional<SecondGain> second_return(const OrbitEquations& equations, const OrbitEvaluation& at,
                                        const ReturnMap& back, const TouchFunctions& functions,
                                        const Eigen::VectorXd& first, const Eigen::VectorXd& second);

/// Returns the matrix P of a cycle map.
Eigen::MatrixXd matrix_of(const CycleMap& map);
/// A cycle map in scaled states.
struct ScaledCycleMap {
    explicit ScaledCycleMap(const CycleMap& map);
    Eigen::MatrixXd matrix;
    Eigen::VectorXd impact, gradient;
};

/// Computes the cycle map from the return map. @param free as above
CycleMap cycle_map_of(const OrbitEquations& equations, const OrbitEvaluation& at, const OrbitTouch& touch,
                      std::optional<std::size_t> free, AskedContacts asked = AskedContacts::all,
                      bool next_order = false);
/// The same with the touched function already compiled.
CycleMap cycle_map_of(const OrbitEquations& equations, const OrbitEvaluation& at, const OrbitTouch& touch,
                      const TouchFunctions& functions, std::optional<std::size_t> free, AskedContacts asked,
                      bool next_order = false);

} // namespace graze
