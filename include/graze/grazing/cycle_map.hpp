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

/// A point at which an orbit touches the surface of an event with zero speed.
struct OrbitTouch {
    std::size_t segment = 0, event = 0;
    double time = 0;     ///< since the start of the segment
    bool at_end = false; ///< the touch is the contact that ends the segment, at zero approach speed
};

struct CycleMapOptions {
    double tolerance = 1e-13; ///< relative tolerance of the integration, 1e-16 .. 1e-2
    /// Parameter that moves the orbit through grazing. It is needed for the clearance rate and the checks by
    /// simulation; without one the map is that of the grazing orbit alone.
    std::optional<ParameterId> parameter;
    bool next_order = false; ///< compute the next order too; this costs second derivatives of the flow around the orbit
};

/// Returns all points at which an orbit touches a surface, to within 1e-7 of the size of the event function, each once.
/// @throws InputError when the orbit does not fit the system
std::vector<OrbitTouch> touches_of(const System& system, const Orbit& orbit, const CycleMapOptions& options = {});

/// The return map of a grazing orbit from touch to touch, to leading order: the discontinuity map followed by the
/// linear map of the orbit (A. B. Nordmark, Phys. Rev. E 55, 1997). With x the active states on the surface of zero
/// event rate, as differences from the orbit without contact,
///
///     x -> P (x + B s),   s = sqrt(-2 a h) where h = C + g x is negative, and 0 elsewhere
///
/// (or B (-h)^(3/2), B (-h) or B h^2 in place of B s), where C is the clearance of that orbit: the minimum of the event
/// function. The orbit may have other contacts; the cycle of a half orbit ends at its image.
///
/// For states of the order of h the error is of order s^2 (h^2 for a compliant contact, h^(3/2) for sliding). The next
/// order adds `second` s^2 for an impact, which leaves an error of order s^3, and `second` (-h)^(3/2) for sliding, with
/// an error of order h^2. A map that is quadratic is the leading difference from the motion without excursion, which
/// the matrix P describes to first order only.
struct CycleMap {
    std::string reason; ///< why the map does not exist, in one line; empty if it does
    OrbitTouch touch;
    std::size_t touches = 1; ///< number of points at which the orbit touches, including this one
    DiscontinuityMap contact;
    bool half = false; ///< the orbit is a half orbit, and the cycle is its half period
    double time = 0;   ///< duration of a cycle
    /// Times since the touch, in one period of the whole orbit, at which the orbit touches the event's surface
    /// (0 first), and at which it has other contacts there.
    std::vector<double> touch_times, contact_times;
    double period = 0;               ///< period of the whole orbit
    std::vector<std::size_t> active; ///< indices of the states that are neither drifting nor neutral
    std::vector<double> scales;      ///< scales of the active states
    std::vector<double> matrix;      ///< P of the active states, row by row
    std::vector<double> impact;      ///< B
    std::vector<double> gradient;    ///< g
    /// Next-order change of the active states after one cycle, in addition to P B s. Empty: unknown or not requested.
    std::vector<double> second;
    double second_clearance = 0; ///< next-order change of h, including its curvature
    /// Multipliers, largest first: eigenvalues of P without the zero eigenvalue of the projection onto the surface.
    std::vector<std::complex<double>> multipliers;
    /// Derivatives with respect to the parameter, if one was given and no multiplier is 1.
    std::optional<double> clearance_rate; ///< derivative of C
    /// Derivative of the state at which the event function of the orbit without contact is least.
    std::vector<double> steady;

    bool exists() const { return reason.empty() && contact.exists(); }
    /// True when a contact with the touched surface belongs to the touch: its time is nearer to that of a touch than to
    /// those of the orbit's other contacts with the surface. @param time since a touch; @param period of the orbit, or
    /// half of it where the surface may be mapped to its image
    bool is_at_touch(double time, double period) const;
    /// Returns g P^k B for k = 1, 2, ..., count: the change of the clearance k cycles after a contact, per unit of its
    /// approach speed (per unit of depth^(3/2), of depth or of depth^2 for other orders of the map). A negative one
    /// leads to another contact. @throws InputError for a count above ten million
    std::vector<double> projections(std::size_t count) const;
    /// Returns the effect of impacts in all previous cycles on the clearance, per unit of approach speed, if all
    /// impacts are equal (sign 1) or alternate in strength (sign -1): the sum of sign^(k-1) g P^k B over k, times det(1
    /// - sign P). This equals g adj(1 - sign P) P B, which is smooth also where a multiplier is 1 or -1. Where it
    /// vanishes along a curve of grazing, a curve of folds (sign 1) or flips (sign -1) of orbits with one impact per
    /// cycle begins. With two multipliers it equals the first projection for both signs.
    double sum_of_projections(int sign) const;
    /// Returns the active states after one cycle, with the next order where it is known.
    /// @param state active states before the cycle; @param clearance of the orbit without contact (C)
    /// @throws InputError if the map does not exist or the numbers do not fit it
    std::vector<double> image(std::span<const double> state, double clearance) const;
};

/// Computes the map of the cycle at one touch.
/// @return a map whose `reason` is set where it does not exist
/// @throws InputError when orbit, touch or options do not fit the system
CycleMap cycle_map(const System& system, const Orbit& orbit, const OrbitTouch& touch,
                   const CycleMapOptions& options = {});

} // namespace graze
