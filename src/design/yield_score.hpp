#pragma once

#include "graze/design/design.hpp"

namespace graze {

/// Score of a value within limits, in standard deviations: if s is the score, a normal distribution about the value has
/// the share 1/2 (1 + erf(s/2^(1/2))) within the limits. Unlike the share itself the score has a useful gradient far
/// outside the limits. Limits may be infinite; the deviation is positive.
double yield_score(double least, double greatest, double value, double deviation);

/// Returns the score of a share between 0 and 1.
double score_of_share(double share);

/// Returns the tolerances of a design for a device with this orbit, and the limits of usable trip values. Without
/// tolerances all devices are equal.
YieldSettings yield_settings_of(const Design& design, const Orbit& orbit);

} // namespace graze
