#pragma once

#include "branch/equilibrium_conditions.hpp"

#include <Eigen/Core>

#include <complex>
#include <optional>
#include <string>

namespace graze {

/// The motion on the centre manifold of a Hopf point, in scaled states: z' = (i frequency + growth_rate dp) z +
/// coefficient z |z|^2, and the state x = z vector + its conjugate + z^2 second + its conjugate + z z* mean + ...
/// (Y. Kuznetsov, "Elements of Applied Bifurcation Theory", 2004, sections 5.4 and 8.7).
struct HopfForm {
    double frequency = 0;
    std::complex<double> coefficient;
    /// Re(coefficient) / frequency for an eigenvector of norm 1 in the units of the model (Kuznetsov's l1); its sign
    /// does not depend on units.
    double lyapunov = 0;
    /// The part of `lyapunov` that may be round-off.
    double uncertainty = 0;
    Eigen::VectorXcd vector, second;
    Eigen::VectorXd mean;
    /// Derivative of the eigenvalue along the branch, by its first free parameter.
    std::complex<double> eigenvalue_rate;
    Eigen::VectorXd state_rate; ///< derivative of the equilibrium by this parameter
};
/// @param third derivatives of the equations
/// @return none where the pair is real, or the field is singular
std::optional<HopfForm> hopf_form(const EquilibriumEvaluation& at, const EquilibriumThirdDerivatives& third,
                                  double product);

/// Returns the criticality in words: "first Lyapunov coefficient -0.5: stable cycles begin (supercritical)".
std::string in_words(const HopfForm& form, std::size_t other_unstable);

} // namespace graze
