#pragma once

#include "orbit/orbit_equations.hpp"
#include "orbit/second_variation.hpp"

#include <cmath>
#include <complex>
#include <optional>
#include <vector>

namespace graze {

// Normal forms of orbits at which multipliers lie on the unit circle (Yu. A. Kuznetsov, "Elements of Applied
// Bifurcation Theory", 2004, sections 5.4 and 8.7), for the map from one first start to the next. The first start of
// the critical vector has Euclidean length 1 in the model's units; its product with the adjoint vector is 1.
//
// They are computed from the equations of all segments without forming the map: A(mu) is the matrix closed by the
// factor mu; F_2 and F_3 are the second and third derivatives of the equations with respect to starts and durations.
// Second derivatives are exact, third derivatives are differences of these.

/// The coefficient of a flip or of a torus point with its error due to round-off.
struct Criticality {
    std::complex<double> form;
    double error = 0;
    bool is_simple = true; ///< false: the multiplier is multiple up to round-off, so that the coefficient is undefined
    double value() const { return form.real(); }
    /// True when the sign is significant; for linear and conservative models the coefficient is zero up to round-off.
    bool is_decided() const { return std::abs(value()) > error; }
};
/// Returns the coefficient c of the flip, w -> -w + c w^3: for c > 0 (supercritical) the bifurcating orbit of twice the
/// period is stable if the original one has no other unstable direction. For a half orbit, the bifurcating orbit is
/// asymmetric.
/// @param at evaluation at an orbit with a multiplier -1. @param variation compiled second derivatives of these
/// equations; compiling takes much longer than evaluating. @return empty where it cannot be computed
std::optional<Criticality> flip_criticality(const OrbitEquations& equations, const OrbitEvaluation& at,
                                            SecondVariation& variation);
/// Returns the coefficient D of the torus, w -> mu w (1 + D |w|^2). For a negative real part (supercritical) the torus
/// is stable, likewise; the imaginary part is the change of the rotation angle.
/// @param at evaluation at an orbit with two multipliers on the unit circle
std::optional<Criticality> torus_criticality(const OrbitEquations& equations, const OrbitEvaluation& at,
                                             SecondVariation& variation);

/// Normal form of a fold, w -> w + b (p - p_0) + a w^2: two orbits exist on one side of the parameter, at w^2 = -b (p -
/// p_0)/a to first order; one of them is stable if there is no other unstable direction.
struct FoldForm {
    double coefficient = 0; ///< a > 0 by choice of the sign of the critical vector, so that orbits at w < 0 are stable
    bool above = false;     ///< two orbits exist at greater values of the first free parameter, none at smaller ones
    bool turns = true;      ///< false: the coefficient is zero up to round-off, so that the side is undecided
    bool is_simple = true;  ///< false: two multipliers are 1 up to round-off, so that a and b are undefined
    double rate = 0;        ///< b, with respect to the first free parameter in its own unit
    /// First starts of the critical and adjoint vectors, in the model's units: w = adjoint (start - start of the fold).
    std::vector<double> critical, adjoint;
};
/// @param at evaluation at an orbit with a multiplier 1, with a free parameter. @return empty where it cannot be
/// computed
std::optional<FoldForm> fold_form(const OrbitEquations& equations, const OrbitEvaluation& at,
                                  SecondVariation& variation);

/// Returns the coefficient c of the cusp, w -> w + c w^3: for c < 0 the outer two of the three orbits are stable.
/// @param at evaluation at an orbit with a multiplier 1 and fold coefficient zero
std::optional<double> cusp_coefficient(const OrbitEquations& equations, const OrbitEvaluation& at,
                                       SecondVariation& variation);

/// Return the units of starts and durations, and those of the equations: for each piece that of its end condition, then
/// those of the states.
Eigen::VectorXd units_of_columns(const OrbitEquations& equations, const OrbitEvaluation& at);
Eigen::VectorXd units_of_rows(const OrbitEquations& equations, const OrbitEvaluation& at);
/// Returns the multipliers of the equations, without a division by contact speeds.
std::vector<std::complex<double>> multipliers_of(const OrbitEquations& equations, const OrbitEvaluation& at);

/// Returns the multiplier in the upper half plane nearest to the unit circle; empty if there is none.
std::optional<std::complex<double>> pair_on_circle(const std::vector<std::complex<double>>& multipliers);

} // namespace graze
