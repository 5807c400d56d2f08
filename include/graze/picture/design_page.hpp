#pragma once

#include "graze/design/design_report.hpp"
#include "graze/picture/figure.hpp"

namespace graze {

/// One page for a review: the trip value against each dimension and in planes of two, with the class coloured; trip
/// times; the tuning curve; how devices are distributed.
/// Every curve, plane and dimension of the report has its panel; the page has as many columns as that takes.
Figure design_page(const Design& design, const TripPoint& trip, const DesignReport& report);

} // namespace graze
