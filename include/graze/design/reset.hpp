#pragma once

#include "graze/design/trip_point.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace graze {

/// Options of `reset_of`.
struct ResetOptions {
    double overshoot = 0;      ///< signed overshoot of the trip value at which the device has tripped
    double least = 0;          ///< value of the control parameter down to which the tripped motion is followed
    std::size_t cycles = 2000; ///< cycles for it to settle
    std::function<bool()> interrupted;
};

/// The reset value: the value of the control parameter down to which a tripped device remains tripped.
struct Reset {
    std::optional<double> value; ///< value at which the tripped motion is lost; empty: `reason` says why
    std::string reason;
    std::string how;                   ///< type of the point there, such as "fold"
    std::string motion;                ///< signature of the tripped motion, if it is a periodic orbit; else its label
    std::optional<double> lost_at;     ///< if found by simulation: a value at which the motion has returned
    std::optional<SpecialPoint> point; ///< the point, if its condition can be continued

    /// Returns trip value less reset value.
    std::optional<double> hysteresis(double trip_value) const;
};

/// Finds the reset value. It simulates the motion beyond the trip point until it settles, and continues its orbit back
/// to where it is lost. If the motion is not such an orbit (at rest on a stop, or chaotic), the control parameter is
/// taken back by simulation in steps until the motion settles on the one that has not tripped: for a motion at rest to
/// 1e-6 of the way to `least`, otherwise along several sequences of steps, which need not find the earliest loss.
/// @param orbit orbit at the trip point
Reset reset_of(const TripPoint& trip, const Orbit& orbit, const ResetOptions& options);

} // namespace graze
