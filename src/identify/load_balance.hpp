#pragma once

#include "graze/identify/coupling.hpp"

#include <string>
#include <vector>

namespace graze {

/// Residual of the equilibrium, times (beta2 + d - q)^2, and its derivatives.
struct LoadBalance {
    double rest = 0;
    double by_displacement = 0, by_current = 0, by_beta1 = 0, by_beta2 = 0, by_stiffness = 0;

    LoadBalance(const StaticLoad& load, const CouplingSettings& settings, double beta1, double beta2) {
        const double q = load.displacement, space = beta2 + settings.gap - q, k = 2 * settings.stiffness;
        rest = k * q * space * space - beta1 * load.current * load.current;
        by_displacement = k * (space * space - 2 * q * space);
        by_current = -2 * beta1 * load.current;
        by_beta1 = -load.current * load.current;
        by_beta2 = 2 * k * q * space; // also the derivative by the gap
        by_stiffness = 2 * q * space * space;
    }
};

/// Returns reasons why loads are not equilibria of such a magnet with random noise, in words; empty if no test fails.
/// @param points estimated true equilibria of the loads. Derivatives are taken there, since derivatives at the loads
/// are correlated with the residuals
/// @param noise_q, noise_i standard deviations; only their ratio matters
std::vector<std::string> reasons_against(std::span<const StaticLoad> loads, std::span<const StaticLoad> points,
                                         const CouplingSettings& settings, double beta1, double beta2, double noise_q,
                                         double noise_i);

} // namespace graze
