#pragma once

#include "graze/record/impacts.hpp"

#include <span>
#include <vector>

namespace graze {

/// Whether velocities after impacts are in proportion to those before, as far as their own errors allow to tell. About
/// a line that is bent or shifted the scatter is large, and hides that it is: therefore a further term is judged by the
/// velocities' own errors, where with that term nothing but these is left. Where more is left (as where restitution
/// differs from impact to impact) the own errors say nothing about a term, and neither does this.
struct ImpactProportion {
    double offset = 1; ///< the chance that errors make up an offset of the velocity, or its drift, as large
    double change = 1; ///< that they make up as large a change of the restitution with speed or from impact to impact
    /// That errors twice as large in the square make impacts as unlike one another about the line through nought: what
    /// an impact's own samples tell of its errors is itself not exact.
    double unlike = 1;
    double scatter = 0; ///< mean square of what is left about the line, over that of the own errors
    double excess = 0;  ///< of the restitution over one, in standard errors by own errors that are inexact likewise
};

/// @param e the coefficient of the line through nought
ImpactProportion test_proportion(std::span<const RecordedImpact> impacts, double e);

/// Impacts whose velocity before is no larger than twice its error, or whose body goes on in the same direction.
std::size_t doubtful_impacts(std::span<const RecordedImpact> impacts);

} // namespace graze
