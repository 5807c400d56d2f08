#pragma once

#include "graze/design/trip_point.hpp"

#include <functional>
#include <optional>
#include <string>

namespace graze {

struct ResetOptions {
    double overshoot = 0;      ///< beyond the trip value, at which the device has tripped; with its sign
    double least = 0;          ///< of the control parameter, down to which the tripped motion is followed
    std::size_t cycles = 2000; ///< for it to settle
    std::function<bool()> interrupted;
};

/// Down to which value of the control parameter a tripped device remains so.
struct Reset {
    std::optional<double> value; ///< where the tripped motion is lost; none: `reason` says why
    std::string reason;
    std::string how;                   ///< what happens there, such as "fold"
    std::string motion;                ///< the tripped motion's signature, if it is an orbit; else what it is
    std::optional<double> lost_at;     ///< of a value found by simulation: one at which it has come back
    std::optional<SpecialPoint> point; ///< of that, whose condition can be held

    /// Trip value less reset value.
    std::optional<double> hysteresis(double trip_value) const;
};

/// Simulates the motion beyond the trip point until it settles, and follows the orbit that it has then, back to where
/// it is lost. A motion that is no such orbit, as one at rest on a stop or a chaotic one, is taken back by simulation
/// in steps, until it settles on the motion that had not tripped: at rest to a millionth of the way to `least`, else on
/// several ways, which need not be all that there are.
/// @param orbit at the trip point
Reset reset_of(const TripPoint& trip, const Orbit& orbit, const ResetOptions& options);

} // namespace graze
