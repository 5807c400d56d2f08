#pragma once

#include "graze/layout/etched_wall.hpp"

#include <cstddef>

namespace graze {

/// One half of a folded flexure: parallel beams connected in series by trusses at alternate ends, from the frame to the
/// first beam, and from the last one by a link to the mass. The first truss continues into the other half, the mirror
/// image about the middle. Lengths in m, after the etch.
struct FoldedSpring {
    std::size_t beams = 2;
    double beam_length = 0;  ///< between trusses
    EtchedWidth beam_width;  ///< in the direction of motion
    double spacing = 0;      ///< clear distance between two beams, and from the last one to the mass
    double half_middle = 0;  ///< clear distance from the first beam to the middle
    EtchedWidth truss_width; ///< along the beams
    double height = 0;       ///< thickness out of the plane
    double modulus = 0;      ///< Young's modulus, in Pa

    // Adjacent compliant parts; a length of 0 makes them rigid.
    /// Finger of the frame, from which both halves hang: as wide as the first beams with the middle.
    double finger_length = 0;
    double bar_length = 0; ///< bar of the mass: clear length from the last link along the beams to the bridge
    EtchedWidth bar_width; ///< in the direction of motion
};

/// Properties of one half.
struct SpringProperties {
    /// In N/m, at the bar's end at the bridge, or at the last link, guided: it neither turns nor moves along the beams.
    double stiffness = 0;
    double stiff_trusses = 0;     ///< the same if only beams bend: 12 E I/(n L^3)
    double stress_per_travel = 0; ///< largest stress of a beam per displacement of the mass, in Pa/m
    /// Area of a plate with the same kinetic energy as beams and trusses, without links, in m^2.
    double moving_area = 0;
};

/// Computes the properties of the frame of Euler-Bernoulli beams: finger, beams, trusses, links and bar. A chain that
/// is clamped at one end is statically determinate: bending moment and axial force of each part follow from the loads
/// at its other end and, by symmetry, a force along the beams in the middle of the first truss. The compliance for
/// these four is the integral of m m'/(E I) + n n'/(E A) along the chain (Castigliano's second theorem; S. P.
/// Timoshenko and D. H. Young, "Theory of Structures", 1965). With the end guided and the middle held along the beams,
/// the stiffness is an entry of its inverse. Joints of beams and trusses are rigid; shear is neglected.
///
/// The trusses move by j/n of the mass's displacement, each beam by the cubic polynomial of a guided one; so two beams
/// and their truss contribute 12/35 and a quarter of their mass to the kinetic energy (W. C. Tang, T.-C. H. Nguyen, M.
/// W. Judy and R. T. Howe, "Electrostatic-comb drive of lateral polysilicon resonators", Sens. Actuators A 21 (1990)).
/// @throws InputError for numbers that are not positive and finite, and for fewer than two beams
SpringProperties properties_of(const FoldedSpring& spring);

} // namespace graze
