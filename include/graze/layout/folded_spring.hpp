#pragma once

#include "graze/layout/etched_wall.hpp"

#include <cstddef>

namespace graze {

/// Beams that lie side by side and are joined one after the other at alternate ends by trusses: from the frame to the
/// first, from the last over a link to the mass. Lengths in m, after the etch.
struct FoldedSpring {
    std::size_t beams = 2;
    double beam_length = 0;  ///< between trusses
    EtchedWidth beam_width;  ///< in the direction of motion
    double spacing = 0;      ///< clear, between two beams and from the last to the mass
    EtchedWidth truss_width; ///< along the beams
    double height = 0;       ///< of all of it, out of the plane
    double modulus = 0;      ///< Young's, in Pa
};

struct SpringProperties {
    double stiffness = 0;         ///< in N/m, of the mass's end, guided: it neither turns nor moves along the beams
    double stiff_trusses = 0;     ///< the same with trusses that do not bend or turn: 12 E I/(n L^3)
    double stress_per_travel = 0; ///< greatest stress of a beam by displacement of the mass, in Pa/m
    double moving_area = 0; ///< of the beams and trusses as if they moved with the mass, in m^2: Rayleigh's quotient
};

/// The frame of Euler and Bernoulli's beams. A chain that is held at one end is statically determinate: bending moment
/// and axial force of each of its parts follow from force and moment at its other end, and the compliance of that end
/// is the integral of m m'/(E I) + n n'/(E A) along the chain (Castigliano's second theorem; S. P. Timoshenko and D. H.
/// Young, "Theory of Structures", 1965). With the turn and the motion along the beams held, the stiffness is an entry
/// of its inverse. Where a beam enters a truss the joint is rigid. Shear is left out.
///
/// The trusses move by shares j/n of the mass, each beam by the cubic polynomial of a guided one; so the kinetic energy
/// counts 12/35 of two beams and a quarter of their truss (W. C. Tang, T.-C. H. Nguyen, M. W. Judy and R. T. Howe,
/// "Electrostatic-comb drive of lateral polysilicon resonators", Sens. Actuators A 21 (1990)).
/// @throws InputError for numbers that are not positive and finite
SpringProperties properties_of(const FoldedSpring& spring);

} // namespace graze
