#pragma once

#include "graze/design/design_report.hpp"
#include "graze/design/trip_point.hpp"

#include <optional>
#include <string>

namespace graze {

/// Where a device trips; its way there is kept in the file. @return none when interrupted
std::optional<TripPoint> locate_trip(const Design& design, const std::string& path, const DesignReportOptions& options);

} // namespace graze
