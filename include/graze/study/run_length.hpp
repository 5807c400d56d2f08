#pragma once

#include "graze/model/model.hpp"
#include "graze/trajectory/probe.hpp"
#include "graze/trajectory/run_control.hpp"
#include "graze/trajectory/trajectory.hpp"

#include <functional>
#include <optional>
#include <string>

namespace graze {

/// How long one motion is simulated, as users say it. Without time, periods and contacts it has 20 periods.
struct RunLengthRequest {
    std::optional<double> time{};  ///< of the part that is shown, in the model's time; not with periods or contacts
    std::optional<int> periods{};  ///< of a cyclic state, in that part
    std::optional<int> contacts{}; ///< in that part
    std::optional<double> after{}; ///< time that passes before that part; not with skip
    std::optional<int> skip{};     ///< periods that pass before it
    std::string phase{};           ///< cyclic state whose periods count; empty: the only one
};

/// The two legs of a simulation: one of which nothing is shown, which may be empty, and one that is shown.
struct RunLength {
    LegEnd transient, shown;
    std::optional<Probe> period; ///< its passages are counted: those of the phase with which the motion begins

    /// The leg with which a trajectory starts.
    const LegEnd& first() const { return transient.empty() ? shown : transient; }
};

/// @throws InputError for lengths that are not positive, contradict each other, or cannot be known
RunLength run_length(const Model& model, const RunLengthRequest& request);

/// Follows a trajectory, started with the duration of the first leg, through both legs. Where it ends by itself or is
/// interrupted in the transient, nothing is shown.
/// @param control the trajectory's observer
/// @param interrupted asked after the transient
/// @param begin called when the shown leg begins
void run_legs(Trajectory& trajectory, JetSet& jets, RunControl& control, const RunLength& length,
              const std::function<bool()>& interrupted, const std::function<void()>& begin);

} // namespace graze
