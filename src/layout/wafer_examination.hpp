#pragma once

#include "graze/branch/device_solver.hpp"
#include "graze/design/design.hpp"
#include "graze/grazing/verdict.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace graze {

/// What is found of a device of a wafer beyond its trip value.
struct ExaminedWaferDevice {
    GrazingOutcome found = GrazingOutcome::undecided; ///< class
    std::optional<double> trip_time;
};

/// The request of wafer_examination_of.
/// @param fold_side as in TripPoint; @param trip with the one overshoot of the trip times, or without any: then none
/// are computed
std::string wafer_request(int fold_side, const TripRequest& trip);

/// @throws InputError for bytes that the examination did not return
ExaminedWaferDevice read_examined(std::string_view bytes);

} // namespace graze
