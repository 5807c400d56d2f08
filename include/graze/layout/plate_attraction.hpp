#pragma once

#include "graze/layout/etched_wall.hpp"

namespace graze {

/// Two blocks that face each other across a trench, with a voltage between them. Lengths in m.
struct FacingPlates {
    double length = 0;  ///< along the trench
    double height = 0;  ///< from the top of the trench to its bottom
    double backing = 0; ///< how far either block reaches back from the trench: its top and bottom carry charge, too
    EtchedWidth gap;    ///< at rest
};

/// The parallel plates without a fringe that attract as these do: with the force epsilon A V^2 / (2 (d - q)^2).
struct EquivalentPlates {
    double area = 0; ///< in m^2
    double gap = 0;  ///< in m
};

/// Force and its first derivative by the displacement are those of the blocks at rest.
///
/// Between the blocks the field is straight in each depth. Where the gap changes linearly with depth the force is that
/// of a gap (g0 g1)^(1/2), and with its derivative the equivalent gap is 2 g0 g1 / (g0 + g1). Along the edges the
/// field bends out: the energy stored there is that of H. B. Palmer, "The capacitance of a parallel-plate capacitor by
/// the Schwartz-Christoffel transformation", Trans. AIEE 56 (1937), for thin plates, with the term for thick ones of
/// V. Leus and D. Elata, "Fringing field effect in electrostatic actuators", Technion ETR-2004-2: per length of the
/// trench and in units of epsilon
///
///     C = h/g + (1 + ln(2 pi h/g))/pi + ln(1 + 2 b/g + 2 (b/g + b^2/g^2)^(1/2))/pi.
///
/// The force is its derivative, so that the height counts as h + (g/pi)(1 + (b/(g + b))^(1/2)), and so does the length.
/// @throws InputError for lengths that are not positive and finite; `backing` may be 0
EquivalentPlates equivalent_plates(const FacingPlates& plates);

/// Capacitance per length over epsilon by that formula, for straight walls. @throws InputError as above
double capacitance_by_length(double height, double gap, double backing);

} // namespace graze
