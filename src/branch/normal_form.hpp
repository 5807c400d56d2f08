#pragma once

#include "orbit/orbit_equations.hpp"
#include "orbit/second_variation.hpp"

#include <cmath>
#include <complex>
#include <optional>
#include <vector>

namespace graze {

// Normal forms of orbits at which multipliers lie on the unit circle (Yu. A. Kuznetsov, "Elements of Applied
// Bifurcation Theory", 2004, sections 5.4 and 8.7), for the map from one first start to the next. The critical vector's
// starts have Euclidean length 1 in the model's units, and the adjoint one the product 1 with it.
//
// They are computed from the equations of all segments, in which the map is never formed: with A(mu) the matrix closed
// by the factor mu, and F_2, F_3 the second and third derivatives of the equations by starts and durations. Second ones
// are exact; third ones are differences of those.

/// Coefficient c of the flip, w -> -w + c w^3: an orbit of twice the period leaves, stable for c > 0 if the one that it
/// leaves had no other unstable direction (supercritical). Of the half of a symmetric orbit: an orbit without symmetry.
/// @param at evaluation at an orbit with a multiplier -1. @return none where it cannot be computed
std::optional<double> flip_coefficient(const OrbitEquations& equations, const OrbitEvaluation& at);
/// The same with second derivatives of these equations that have been compiled before, which takes far longer than to
/// evaluate them.
std::optional<double> flip_coefficient(const OrbitEquations& equations, const OrbitEvaluation& at,
                                       SecondVariation& variation);

/// Coefficient d of the torus, |w| -> |w| (1 + d |w|^2): it is stable for d < 0 (supercritical), likewise.
/// @param at evaluation at an orbit with two multipliers on the unit circle
std::optional<double> torus_coefficient(const OrbitEquations& equations, const OrbitEvaluation& at);
/// The same as the real part of w -> mu w (1 + D |w|^2), whose imaginary one says how the angle changes, with second
/// derivatives that have been compiled before.
std::optional<std::complex<double>> torus_form(const OrbitEquations& equations, const OrbitEvaluation& at,
                                               SecondVariation& variation);

/// The coefficient of a flip or of a torus point with what round-off of all that it is made of may be of it.
struct Criticality {
    double value = 0, error = 0;
    bool is_simple = true; ///< false: another multiplier is equal up to round-off, so that there is no value
    /// Whether its sign means something: that of a linear or conservative model is zero up to round-off.
    bool is_decided() const { return std::abs(value) > error; }
};
std::optional<Criticality> flip_criticality(const OrbitEquations& equations, const OrbitEvaluation& at);
std::optional<Criticality> torus_criticality(const OrbitEquations& equations, const OrbitEvaluation& at);

/// What happens at a fold, w -> w + b (p - p_0) + a w^2: two orbits on one side of the parameter, of which one is
/// stable if there is no other unstable direction, at w^2 = -b (p - p_0)/a to first order.
struct FoldForm {
    double coefficient = 0; ///< a > 0, which the sign of the critical vector decides: orbits at w < 0 are stable
    bool above = false;     ///< two orbits at greater values of the first free parameter, none at smaller ones
    bool turns = true;      ///< false: the coefficient is zero up to round-off, and so is on which side
    bool is_simple = true;  ///< false: two multipliers are 1 up to round-off, so that a and b have no values
    double rate = 0;        ///< b, by the first free parameter in its own unit
    /// The critical vector in the first start, and the adjoint one, in the model's units: w = adjoint (start - fold's).
    std::vector<double> critical, adjoint;
};
/// @param at evaluation at an orbit with a multiplier 1, with a free parameter. @return none where it cannot be
/// computed
std::optional<FoldForm> fold_form(const OrbitEquations& equations, const OrbitEvaluation& at);

/// Coefficient c of the cusp, w -> w + c w^3: of the three orbits that meet there the outer ones are stable for c < 0.
/// @param at evaluation at an orbit with a multiplier 1 whose fold has the coefficient zero
std::optional<double> cusp_coefficient(const OrbitEquations& equations, const OrbitEvaluation& at);

/// The complex multiplier, of those above the real axis, that is nearest to the unit circle; if there is one.
std::optional<std::complex<double>> pair_on_circle(const std::vector<std::complex<double>>& multipliers);

} // namespace graze
