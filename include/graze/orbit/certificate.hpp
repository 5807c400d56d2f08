#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace graze {

/// A least value of a watched event's function inside an arc, where the event would happen were it lower. Of sections,
/// which may have either sign, also a greatest one, as its negative: of both beside a fall the one nearer to zero.
struct OrbitMinimum {
    std::size_t segment = 0, event = 0;
    double time = 0; ///< since the segment's start
    double value = 0;
    double size = 0; ///< of the function along the arc, by which round-off is to be measured
};

/// Least value of an event function, as a share of its size, that round-off and the accuracy of an orbit cannot tell
/// from zero.
inline constexpr double smallest_clearance = 1e-11;

/// Value of a watched event's function, which is not the segment's own, at its end.
struct EndValue {
    std::size_t segment = 0, event = 0;
    double value = 0;
    double rate = 0; ///< along the flow
};

/// What has been checked of an orbit's segments: that the model would really follow them.
struct Certificate {
    bool admissible = true;
    std::string reason;                  ///< why not: the first thing wrong
    std::vector<double> approach_speeds; ///< of each segment's event or section at its end: positive when it falls
    std::vector<double> departures;      ///< the same event's rate just after the jump
    std::vector<double> guard_margins;   ///< of each transition: how far its way on is from being another one
    std::vector<OrbitMinimum> minima;    ///< inside arcs
    std::vector<EndValue> end_values;
};

} // namespace graze
