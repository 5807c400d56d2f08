#pragma once

#include "graze/identify/estimate.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// An equilibrium under a constant voltage.
struct StaticLoad {
    double displacement = 0, current = 0;
};

/// What is known beforehand, with standard errors where they are not nought.
struct CouplingSettings {
    double gap = 0, gap_error = 0;             ///< d, at rest
    double stiffness = 0, stiffness_error = 0; ///< m w0^2
    /// Noise of the measured displacements and currents, or only in which ratio they are. Both 0: in the ratio of the
    /// largest displacement and the largest current.
    double displacement_noise = 0, current_noise = 0;
};

/// Constants of the force beta1 I^2/(2 (beta2 + d - q)^2) between coil and mass.
struct Coupling {
    Estimate beta1, beta2;
    double correlation = 0; ///< of the two, without what is known beforehand
    /// By Eqs. (5.15) and (5.16) of B. E. Wilcox's dissertation, which take measured displacements as exact.
    double regression_beta1 = 0, regression_beta2 = 0;
    std::vector<double> residuals; ///< by how much each displacement differs from the equilibrium at its current
    /// Why these are no equilibria of such a magnet with nothing but noise, in words; empty: they may be. Tested are an
    /// offset, a drift from load to load and a bend of either scale (F tests, to one chance in 10^4), single loads that
    /// lie far off, and what is left in the order of displacements (ResidualTest).
    std::vector<std::string> reasons;
};

/// From equilibria m w0^2 q = beta1 I^2/(2 (beta2 + d - q)^2), Eq. (5.13): least squares in which displacements and
/// currents are both noisy, and the equilibria themselves are found along with the constants (H. I. Britt and R. H.
/// Luecke, Technometrics 15 (1973) 233). Errors come from the scatter, and from those of what is known beforehand.
/// @throws InputError for fewer than three equilibria, or such that do not tell both constants
Coupling coupling(std::span<const StaticLoad> loads, const CouplingSettings& settings);

} // namespace graze
