#pragma once

#include "graze/grazing/discontinuity_map.hpp"
#include "graze/orbit/orbit.hpp"

#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Where an orbit meets an event's surface without speed.
struct OrbitTouch {
    std::size_t segment = 0, event = 0;
    double time = 0;     ///< since the segment's start
    bool at_end = false; ///< it is the contact that ends the segment which has lost its speed
};

struct CycleMapOptions {
    double tolerance = 1e-13; ///< of the integration; 1e-16 .. 1e-2
    /// By which the orbit is moved from grazing; none: the map is that of the grazing orbit alone.
    std::optional<ParameterId> parameter;
    bool next_order = false; ///< also that, which takes second derivatives of the motion around the orbit
};

/// All places at which an orbit touches a surface, to within some 1e-7 of the size of the event's function; each once.
/// @throws InputError when the orbit does not fit the system
std::vector<OrbitTouch> touches_of(const System& system, const Orbit& orbit, const CycleMapOptions& options = {});

/// The map of one cycle of an orbit that touches, from touch to touch, to leading order: the discontinuity map followed
/// by the linear map of the orbit (A. B. Nordmark, Phys. Rev. E 55, 1997). Of states in which cycles matter, on the
/// surface where the rate of the event's function is zero, as differences from the orbit without contact,
///
///     x -> P (x + B s),   s = sqrt(-2 a h) where h = C + g x is negative, and 0 elsewhere
///
/// (or B (-h)^(3/2) or B (-h) in place of B s), where C is the clearance of that orbit. The orbit may have contacts of
/// its own; the cycle of a half orbit ends at its image.
///
/// States that are as small as h are off by s^2 (h^2 of a compliant contact, h^(3/2) of sliding). With the next order,
/// of an impact `second` s^2 more, they are off by s^3 only; of sliding it is `second` (-h)^(3/2), with an error of
/// h^2.
struct CycleMap {
    std::string reason; ///< why there is none, in one line; empty if there is one
    OrbitTouch touch;
    std::size_t touches = 1; ///< places in which the orbit touches, this one included
    DiscontinuityMap contact;
    bool half = false; ///< the orbit is given by its half, after which the cycle ends
    double time = 0;   ///< of a cycle
    /// When the touched event is met in one period of the whole orbit, since the touch: where it touches, at first, and
    /// where the orbit has contacts of its own.
    std::vector<double> touch_times, contact_times;
    double period = 0;               ///< of the whole orbit
    std::vector<std::size_t> active; ///< states that are neither drifting nor unchanged by everything
    std::vector<double> scales;      ///< of those, and the following too
    std::vector<double> matrix;      ///< P, row by row
    std::vector<double> impact;      ///< B
    std::vector<double> gradient;    ///< g
    /// The next order, one cycle later: what the active states have gained besides P B s. Empty: not known, or not
    /// asked for.
    std::vector<double> second;
    double second_clearance = 0; ///< the same of h, whose own curvature counts, too
    /// Eigenvalues of P but the one that belongs to the projection onto the surface: multipliers, largest first.
    std::vector<std::complex<double>> multipliers;
    /// With respect to the parameter, if one was given and no multiplier is 1.
    std::optional<double> clearance_rate; ///< of C
    std::vector<double> steady;           ///< of the state in which the orbit without contact is at its least value

    bool exists() const { return reason.empty() && contact.exists(); }
    /// g P^k B for k = 1, 2, ...: what a contact does to the clearance k cycles later, by its approach speed (or by the
    /// power 3/2 of its depth). Negative where it leads to another contact.
    std::vector<double> projections(std::size_t count) const;
    /// What impacts in all cycles before do to the clearance of one, by their approach speed, if all are alike (sign 1)
    /// or each is as much harder as the next is softer (sign -1): the sum of sign^(k-1) g P^k B over all k, times the
    /// determinant of 1 - sign P. So it is g adj(1 - sign P) P B, which is smooth where a multiplier is 1 or -1 as
    /// well, and is there without any limit. Folds (sign 1) and flips (sign -1) of orbits with an impact in each cycle
    /// begin on those that graze where it vanishes; with two multipliers it is the first projection, for both signs.
    double sum_of_projections(int sign) const;
    /// One cycle: the active states after it. With the next order where it is known.
    /// @param state of as many, before; @param clearance of the orbit without contact (C)
    /// @throws InputError for a map that does not exist, and numbers that do not fit it
    std::vector<double> image(std::span<const double> state, double clearance) const;
};

/// The map of the cycle at one touch.
/// @return one with a reason where there is none
/// @throws InputError when orbit, touch or options do not fit the system
CycleMap cycle_map(const System& system, const Orbit& orbit, const OrbitTouch& touch,
                   const CycleMapOptions& options = {});

} // namespace graze
