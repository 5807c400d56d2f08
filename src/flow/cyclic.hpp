#pragma once

#include <cmath>

namespace graze {

/// The value of a cyclic state within its period: at least 0, and less than the period. Of others, whose period is 0,
/// the value itself.
inline double within_period(double value, double period) {
    if (!(period > 0))
        return value;
    value -= std::floor(value / period) * period;
    return value >= period ? 0 : value; // what is lower than 0 by round-off alone
}

/// The difference of two values of a cyclic state, whole periods apart from which they are the same. Of others, the
/// difference itself.
inline double without_turns(double difference, double period) {
    return period > 0 ? difference - std::round(difference / period) * period : difference;
}

} // namespace graze
