#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/trip/simulated_trip.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// A fold of orbits with what decides how long motions linger where its two orbits have gone: with w the distance from
/// the orbit of the fold along its critical vector, of one cycle to the next
///
///     w' = w + b (p - value) + a w^2.
struct FoldPassage {
    Orbit orbit;            ///< of the fold, whole
    ParameterId parameter;  ///< p
    double value = 0;       ///< of the parameter at the fold
    double coefficient = 0; ///< a > 0, by the length of states in the model's units: orbits at w < 0 are stable
    double rate = 0;        ///< b, by the parameter's unit
    int side = 0;           ///< of the parameter on which there is no orbit: 1 above, -1 below
    double cycle = 0;       ///< time of one
    bool attracting =
        false; ///< all other multipliers lie within the unit circle: what passes comes from a stable orbit
    std::vector<double> critical, adjoint; ///< w = adjoint (start - fold's), start = fold's + w critical
    double gate = 0; ///< the passage that a simulation is asked for goes from w = -gate to w = gate

    /// Of the normal form's exponent: a multiplier is 1 - 2 root of the stable orbit as far before the fold, and what
    /// is beyond takes pi/root cycles to pass.
    double root(double overshoot) const;
};

/// @param point a fold, or a point of a curve of folds
/// @throws InputError for other points, where the parameter does not move the orbit from the fold, and where the
///         coefficient is zero or cannot be computed
FoldPassage fold_passage(const System& system, const SpecialPoint& point, ParameterId parameter);

/// Cycles from far on the one side of the fold's orbit to far on the other, pi/sqrt(a b overshoot), to leading order
/// (Y. Pomeau and P. Manneville, Commun. Math. Phys. 74, 1980).
/// @throws InputError for an overshoot to the side of the orbits, or none
double cycles_of_passage(const FoldPassage& fold, double overshoot);
/// The same from one w to another, both of them near the fold.
double cycles_of_passage(const FoldPassage& fold, double overshoot, double from, double to);

/// A passage by simulation, from w = -gate on.
struct SimulatedPassage {
    bool passed = false; ///< w = gate has been reached
    double cycles = 0;   ///< until then: returns to the section of the orbit's start, the last in part
    double time = 0;     ///< likewise
    TripTime trip;       ///< until the end that was asked for
};

/// Least overshoot that a simulation can tell from none: the value of a fold is known to fewer digits than numbers
/// have.
double least_overshoot(const FoldPassage& fold);

/// @param end whose speed must be 0: a fold has no contact of its own; @param until_passed or there, if that is first
/// @throws InputError as above
SimulatedPassage simulated_passage(const System& system, const FoldPassage& fold, double overshoot, const TripEnd& end,
                                   bool until_passed, const TripOptions& options = {});

} // namespace graze
