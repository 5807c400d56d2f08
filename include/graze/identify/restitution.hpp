#pragma once

#include "graze/identify/estimate.hpp"

#include <span>
#include <vector>

namespace graze {

/// Velocities relative to the stop just before and after an impact, of opposite signs.
struct ImpactSpeeds {
    double before = 0, after = 0;
    double before_error = 1, after_error = 1; ///< standard errors, or only in which ratio they are
};

struct Restitution {
    Estimate coefficient;          ///< e of after = -e before
    double mean_ratio = 0;         ///< mean of -after/before, as in section 5.3.1 of B. E. Wilcox's dissertation
    std::vector<double> residuals; ///< after + e before
};

/// The straight line through nought that is nearest to the impacts when both velocities are noisy, which a mean of
/// ratios or a regression is not (W. E. Deming's regression; W. A. Fuller, Measurement Error Models (1987),
/// section 1.3). The error comes from the scatter about the line, whatever the size of the errors given.
/// @throws InputError for fewer than two impacts, or velocities that are no impacts
Restitution restitution(std::span<const ImpactSpeeds> impacts);

} // namespace graze
