#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// A minimum of a watched event function inside an arc: the event would happen there if the minimum fell below zero.
/// The function of a section may have either sign, so its maxima count too, stored as minima of the negated function;
/// next to a sign change from plus to minus only the extremum nearer to zero is listed.
struct OrbitMinimum {
    std::size_t segment = 0, event = 0;
    double time = 0; ///< since the start of the segment
    double value = 0;
    double size = 0; ///< largest magnitude of the function along the arc: the scale of its round-off
};

/// Event function values below this fraction of the function's size cannot be told from zero, given round-off and the
/// accuracy of an orbit.
inline constexpr double smallest_clearance = 1e-11;

/// Value, at the end of a segment, of a watched event function other than the one that ends the segment.
struct EndValue {
    std::size_t segment = 0, event = 0;
    double value = 0;
    double rate = 0; ///< along the flow
};

/// Result of checking that the model would really follow the segments of an orbit.
struct Certificate {
    bool admissible = true;
    std::string reason; ///< why the orbit is not admissible: the first violation found; empty otherwise
    std::vector<double> approach_speeds; ///< per segment: minus the rate of its event (the absolute rate of its
                                         ///< section) at the end; positive for a falling event
    std::vector<double> departures;      ///< per segment: rate of the same event function just after the jump
    std::vector<double> guard_margins;   ///< per segment: margin by which the guards choose the next mode; negative if
                                         ///< they choose another one
    std::vector<OrbitMinimum> minima;    ///< minima of event functions inside the arcs
    std::vector<EndValue> end_values;
};

} // namespace graze
