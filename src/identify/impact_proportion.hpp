#pragma once

#include "graze/record/impacts.hpp"

#include <span>

namespace graze {

/// Tests whether velocities after impacts are proportional to those before, by the velocities' own errors. The scatter
/// about the line cannot tell: a line that is bent or shifted enlarges it. A further term is tested only if the
/// residuals with it are consistent with the own errors; otherwise (as where restitution differs from impact to impact)
/// its p value is 1.
struct ImpactProportion {
    double offset = 1; ///< p value: errors alone produce an offset of the velocity, or a drift, as large
    double change = 1; ///< p value of a change of the restitution with speed or from impact to impact
    /// The p value of the scatter about the line through the origin for errors twice as large in the square, since the
    /// errors of an impact are themselves estimated.
    double unlike = 1;
    double scatter = 0; ///< mean square of the residuals of the line, in units of the own errors
    double excess = 0;  ///< by how much the restitution exceeds one, in standard errors (with the same allowance)
};

/// @param e coefficient of restitution, from the line through the origin
ImpactProportion test_proportion(std::span<const RecordedImpact> impacts, double e);

/// Counts impacts whose velocity before is at most twice its error, or whose body continues in the same direction.
std::size_t doubtful_impacts(std::span<const RecordedImpact> impacts);

} // namespace graze
