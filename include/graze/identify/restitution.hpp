#pragma once

#include "graze/identify/estimate.hpp"

#include <span>
#include <vector>

namespace graze {

/// Velocities relative to the stop just before and just after an impact; their signs are opposite.
struct ImpactSpeeds {
    double before = 0, after = 0;
    double before_error = 1, after_error = 1; ///< standard errors; only their ratios matter
};

/// An estimated coefficient of restitution.
struct Restitution {
    Estimate coefficient;          ///< e in after = -e before
    double mean_ratio = 0;         ///< mean of -after/before, as in section 5.3.1 of B. E. Wilcox's dissertation
    std::vector<double> residuals; ///< after + e before
};

/// Estimates the coefficient of restitution by Deming's regression: the straight line through the origin that is
/// nearest to the impacts when both velocities are noisy (W. A. Fuller, Measurement Error Models (1987), section 1.3).
/// A mean of ratios or an ordinary regression would be biased. The standard error comes from the scatter about the
/// line, whatever the size of the given errors.
/// @throws InputError for fewer than two impacts, or velocities that do not change sign
Restitution restitution(std::span<const ImpactSpeeds> impacts);

} // namespace graze
