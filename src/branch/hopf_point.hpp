#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// An equilibrium at which a pair of eigenvalues crosses the imaginary axis, so that a branch of small orbits begins
/// there.
struct HopfPoint {
    std::vector<double> state;
    double parameter = 0;
    double period = 0; ///< limit period of the orbits
    double error = 0;  ///< error of the parameter, due to round-off
};

/// Computes the Hopf point of a mode's vector field near a state, from the equations of the equilibrium, so that it
/// does not depend on sections of orbits.
/// @param parameters values of all independent parameters, of which `parameter` varies; @param period of a nearby orbit
/// @param scales of the states
/// @return empty where Newton's or the secant method does not converge
std::optional<HopfPoint> hopf_near(const System& system, std::size_t mode, std::span<const double> state,
                                   std::span<const double> parameters, ParameterId parameter, double period,
                                   std::span<const double> scales);

} // namespace graze
