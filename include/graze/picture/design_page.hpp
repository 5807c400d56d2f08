#pragma once

#include "graze/design/design_report.hpp"
#include "graze/picture/figure.hpp"

namespace graze {

/// A page for a design review: panels of the trip value over each dimension and over planes of two dimensions, coloured
/// by class; of trip times; of the tuning curve; and of the distribution of devices. Every curve and plane of the
/// report has a panel; the number of columns grows with the number of panels.
Figure design_page(const Design& design, const TripPoint& trip, const DesignReport& report);

} // namespace graze
