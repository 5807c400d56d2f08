#pragma once

#include "graze/design/design_report.hpp"
#include "graze/study/figure.hpp"

namespace graze {

/// One page for a review: the trip value against each dimension and in planes of two, with the class coloured; trip
/// times; the tuning curve; how devices are distributed.
/// @param most_curves how many dimensions get a panel: the first ones
Figure design_page(const Design& design, const TripPoint& trip, const DesignReport& report,
                   std::size_t most_curves = 4);

} // namespace graze
