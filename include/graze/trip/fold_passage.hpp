#pragma once

#include "graze/branch/special_point.hpp"
#include "graze/trip/simulated_trip.hpp"

#include <vector>

namespace graze {

/// A fold of orbits with its normal form, which determines how long motions linger near the vanished orbits. With w the
/// coordinate along the critical vector, relative to the orbit of the fold, one cycle maps w to
///
///     w' = w + b (p - value) + a w^2.
struct FoldPassage {
    Orbit orbit;             ///< orbit at the fold, a whole orbit
    ParameterId parameter;   ///< p
    double value = 0;        ///< value of the parameter at the fold
    double coefficient = 0;  ///< a > 0, with w in the model's units: orbits at w < 0 are stable
    double rate = 0;         ///< b, per unit of the parameter
    int side = 0;            ///< side of the parameter without orbits: 1 above, -1 below
    double cycle = 0;        ///< duration of a cycle
    bool attracting = false; ///< all other multipliers lie inside the unit circle, so that the lost orbit was stable
    std::vector<double> critical,
        adjoint;     ///< w = adjoint (start - start of the fold); start = start of the fold + w critical
    double gate = 0; ///< simulated passages go from w = -gate to w = gate

    /// Returns sqrt(a |b overshoot|): at this distance before the fold the stable orbit has the multiplier 1 - 2 root,
    /// and beyond it a passage takes pi/root cycles.
    double root(double overshoot) const;
};

/// @param point Computes the normal form. @param point a fold, or a point of a curve of folds
/// @throws InputError for other points, if the parameter does not move the orbit from the fold, or if the
/// coefficient is zero or cannot be computed
FoldPassage fold_passage(const System& system, const SpecialPoint& point, ParameterId parameter);

/// Returns the number of cycles of a passage from w = -infinity to infinity, pi/sqrt(a b overshoot), to leading order
/// (Y. Pomeau and P. Manneville, Commun. Math. Phys. 74, 1980).
/// @throws InputError for an overshoot of zero or to the side on which orbits exist
double cycles_of_passage(const FoldPassage& fold, double overshoot);
/// The same between two finite values of w.
double cycles_of_passage(const FoldPassage& fold, double overshoot, double from, double to);

/// A simulated passage that starts at w = -gate.
struct SimulatedPassage {
    bool passed = false; ///< true when w = gate has been reached
    double cycles = 0;   ///< cycles until then: returns to the section of the orbit's start, interpolated in the last
    double time = 0;     ///< time until then
    TripTime trip;       ///< trip until the requested end
};

/// Returns the smallest overshoot that a simulation can resolve: the value of a fold is known to fewer digits than
/// double precision has.
double least_overshoot(const FoldPassage& fold);

/// @param end its speed must be 0, since a fold has no contact of its own; @param until_passed stop at w = gate, if
/// that is reached first
/// @throws InputError as above
SimulatedPassage simulated_passage(const System& system, const FoldPassage& fold, double overshoot, const TripEnd& end,
                                   bool until_passed, const TripOptions& options = {});

} // namespace graze
