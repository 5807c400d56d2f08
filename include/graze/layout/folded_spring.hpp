#pragma once

#include "graze/layout/etched_wall.hpp"

#include <cstddef>

namespace graze {

/// One half of a folded flexure: beams that lie side by side and are joined one after the other at alternate ends by
/// trusses, from the frame to the first, from the last over a link to the mass. The first truss goes on to the other
/// half, the mirror image beyond the middle. Lengths in m, after the etch.
struct FoldedSpring {
    std::size_t beams = 2;
    double beam_length = 0;  ///< between trusses
    EtchedWidth beam_width;  ///< in the direction of motion
    double spacing = 0;      ///< clear, between two beams and from the last to the mass
    double half_middle = 0;  ///< clear, from the first beam to the middle
    EtchedWidth truss_width; ///< along the beams
    double height = 0;       ///< of all of it, out of the plane
    double modulus = 0;      ///< Young's, in Pa

    // What it is joined to; a length of 0 makes it rigid.
    double finger_length = 0; ///< of the frame, from which both halves hang: as wide as the first beams with the middle
    double bar_length = 0;    ///< of the mass, clear, from the last link along the beams to the bridge
    EtchedWidth bar_width;    ///< in the direction of motion
};

/// Of one half.
struct SpringProperties {
    double stiffness = 0;         ///< in N/m, of the bar's end at the bridge, or of the last link's, guided: it neither
                                  ///< turns nor moves along the beams
    double stiff_trusses = 0;     ///< the same with beams alone that bend: 12 E I/(n L^3)
    double stress_per_travel = 0; ///< greatest stress of a beam by displacement of the mass, in Pa/m
    double moving_area = 0; ///< of a plate with the same kinetic energy as beams and trusses, without links, in m^2
};

/// The frame of Euler and Bernoulli's beams: finger, beams, trusses, links and the bar. A chain that is held at one end
/// is statically determinate: bending moment and axial force of each of its parts follow from the loads at its other
/// end and, by symmetry, a force along the beams in the middle of the first truss. The compliance for these four is the
/// integral of m m'/(E I) + n n'/(E A) along the chain (Castigliano's second theorem; S. P. Timoshenko and D. H. Young,
/// "Theory of Structures", 1965). Where the end is guided and the middle held along the beams, the stiffness is an
/// entry of its inverse. Joints of beams and trusses are rigid; shear is left out.
///
/// The trusses move by shares j/n of the mass, each beam by the cubic polynomial of a guided one; so the kinetic energy
/// of two beams and their truss counts 12/35 and a quarter (W. C. Tang, T.-C. H. Nguyen, M. W. Judy and R. T. Howe,
/// "Electrostatic-comb drive of lateral polysilicon resonators", Sens. Actuators A 21 (1990)).
/// @throws InputError for numbers that are not positive and finite, and for less than two beams
SpringProperties properties_of(const FoldedSpring& spring);

} // namespace graze
