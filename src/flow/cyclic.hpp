#pragma once

#include <cmath>

namespace graze {

/// Returns the value of a cyclic state reduced to [0, period). A period of 0 means not cyclic: the value is unchanged.
inline double within_period(double value, double period) {
    if (!(period > 0))
        return value;
    value -= std::floor(value / period) * period;
    return value >= period ? 0 : value; // the value was below 0 by round-off only
}

/// Returns the difference of two values of a cyclic state modulo the period, nearest to 0. A period of 0 means not
/// cyclic: the difference is unchanged.
inline double without_turns(double difference, double period) {
    return period > 0 ? difference - std::round(difference / period) * period : difference;
}

} // namespace graze
