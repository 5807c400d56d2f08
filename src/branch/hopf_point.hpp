#pragma once

#include "graze/flow/system.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace graze {

/// An equilibrium at which a pair of eigenvalues crosses the imaginary axis: small orbits about it begin there.
struct HopfPoint {
    std::vector<double> state;
    double parameter = 0;
    double period = 0; ///< of these orbits
    double error = 0;  ///< of the parameter, by round-off
};

/// The Hopf point of a mode's field near a state: solved for from the equilibrium's own equations, so that it does not
/// depend on where orbits are cut.
/// @param parameters all independent ones, of which one varies; @param period of an orbit about it
/// @param scales of the states
/// @return none where Newton's and the secant method do not lead to one
std::optional<HopfPoint> hopf_near(const System& system, std::size_t mode, std::span<const double> state,
                                   std::span<const double> parameters, ParameterId parameter, double period,
                                   std::span<const double> scales);

} // namespace graze
