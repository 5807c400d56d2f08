#pragma once

#include "graze/design/design_report.hpp"
#include "graze/design/trip_point.hpp"

#include <optional>
#include <string>

namespace graze {

/// Finds the trip point of a device, and stores the branch that leads there in the file. @return nothing when
/// interrupted
std::optional<TripPoint> locate_trip(const Design& design, const std::string& path, const DesignReportOptions& options);

} // namespace graze
