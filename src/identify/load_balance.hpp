#pragma once

#include "graze/identify/coupling.hpp"

#include <string>
#include <vector>

namespace graze {

/// Both sides of the equilibrium times (beta2 + d - q)^2, less one another, and derivatives.
struct LoadBalance {
    double rest = 0;
    double by_displacement = 0, by_current = 0, by_beta1 = 0, by_beta2 = 0, by_stiffness = 0;

    LoadBalance(const StaticLoad& load, const CouplingSettings& settings, double beta1, double beta2) {
        const double q = load.displacement, space = beta2 + settings.gap - q, k = 2 * settings.stiffness;
        rest = k * q * space * space - beta1 * load.current * load.current;
        by_displacement = k * (space * space - 2 * q * space);
        by_current = -2 * beta1 * load.current;
        by_beta1 = -load.current * load.current;
        by_beta2 = 2 * k * q * space; // and by the gap
        by_stiffness = 2 * q * space * space;
    }
};

/// Why loads are no equilibria of such a magnet with nothing but noise, in words; empty: they may be.
/// @param points of the curve that belong to the loads: derivatives are taken there, since those at the loads share
///        their noise with what is left
/// @param noise_q, noise_i their ratio is what counts
std::vector<std::string> reasons_against(std::span<const StaticLoad> loads, std::span<const StaticLoad> points,
                                         const CouplingSettings& settings, double beta1, double beta2, double noise_q,
                                         double noise_i);

} // namespace graze
