#pragma once

#include "graze/layout/etched_wall.hpp"

namespace graze {

/// Two blocks with opposing faces on both sides of a trench, and a voltage between them. Lengths in m.
struct FacingPlates {
    double length = 0;  ///< along the trench
    double height = 0;  ///< from the top of the trench to its bottom
    double backing = 0; ///< depth of either block behind its face: its top and bottom carry charge, too
    EtchedWidth gap;    ///< at rest
};

/// Parallel plates without fringe field and the same attraction, epsilon A V^2 / (2 (d - q)^2).
struct EquivalentPlates {
    double area = 0; ///< in m^2
    double gap = 0;  ///< in m
};

/// Returns the equivalent plates: force and its first derivative by the displacement equal those of the blocks at rest.
///
/// Between the blocks the field is one-dimensional at each depth. For a gap that changes linearly with depth, the force
/// is that of a gap (g0 g1)^(1/2), and with its derivative the equivalent gap is 2 g0 g1 / (g0 + g1). For the fringe
/// field along the edges, the stored energy is that of H. B. Palmer, "The capacitance of a parallel-plate capacitor by
/// the Schwartz-Christoffel transformation", Trans. AIEE 56 (1937), for thin plates, with the term for thick ones of V.
/// Leus and D. Elata, "Fringing field effect in electrostatic actuators", Technion ETR-2004-2: per length of the trench
/// and in units of epsilon
///
///     C = h/g + (1 + ln(2 pi h/g))/pi + ln(1 + 2 b/g + 2 (b/g + b^2/g^2)^(1/2))/pi.
///
/// The force is its derivative, so the effective height is h + (g/pi)(1 + (b/(g + b))^(1/2)), and likewise the
/// effective length.
/// @throws InputError for lengths that are not positive and finite; `backing` may be 0
EquivalentPlates equivalent_plates(const FacingPlates& plates);

/// Returns the capacitance per length over epsilon by that formula, for vertical walls. @throws InputError as above
double capacitance_by_length(double height, double gap, double backing);

} // namespace graze
