#pragma once

#include "graze/identify/estimate.hpp"

#include <span>
#include <string>
#include <vector>

namespace graze {

/// A measured equilibrium of the mass under a constant voltage: its displacement q and the current I of the coil.
struct StaticLoad {
    double displacement = 0, current = 0;
};

/// Quantities of `coupling` that are known beforehand; a standard error of 0 means exact. Units are those of the loads.
struct CouplingSettings {
    double gap = 0, gap_error = 0;             ///< air gap d without current
    double stiffness = 0, stiffness_error = 0; ///< stiffness m w0^2 of the suspension
    /// Standard deviations of the measured displacements and currents; only their ratio matters. Both 0: in the ratio
    /// of the largest displacement to the largest current.
    double displacement_noise = 0, current_noise = 0;
};

/// Estimated constants of the force beta1 I^2/(2 (beta2 + d - q)^2) between coil and mass.
struct Coupling {
    Estimate beta1, beta2;
    /// Correlation of beta1 and beta2 by the noise of the loads alone (not by errors of gap and stiffness).
    double correlation = 0;
    /// The same constants by the regression of Eqs. (5.15) and (5.16) of B. E. Wilcox's dissertation, which takes
    /// measured displacements as exact.
    double regression_beta1 = 0, regression_beta2 = 0;
    std::vector<double> residuals; ///< measured displacement less that of the equilibrium at its current
    /// Reasons why the loads are not equilibria of such a magnet with random noise, in words; empty: no test fails. The
    /// tests look for an offset, a drift from load to load and a curvature of either scale (F tests at a level of
    /// 1e-4), for single outliers, and for structure of the residuals in the order of displacements (ResidualTest).
    std::vector<std::string> reasons;
};

/// Estimates beta1 and beta2 from equilibria m w0^2 q = beta1 I^2/(2 (beta2 + d - q)^2), Eq. (5.13), by least squares
/// with errors in both variables: displacements and currents are both noisy, so the true equilibria are estimated along
/// with the constants (H. I. Britt and R. H. Luecke, Technometrics 15 (1973) 233). Standard errors combine the scatter
/// of the loads with the errors of the settings.
/// @throws InputError for fewer than three equilibria, or for loads that do not determine both constants
Coupling coupling(std::span<const StaticLoad> loads, const CouplingSettings& settings);

} // namespace graze
