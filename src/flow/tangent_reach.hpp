#pragma once

#include "tape/tangent_series.hpp"

#include <cstddef>
#include <functional>
#include <span>

namespace graze {

/// Sizes below which derivatives need not be known, [state * width + direction]: asked for only where the derivatives'
/// own sizes are too small a measure.
using TangentFloors = std::function<std::span<const double>()>;

/// How differences between slopes of derivatives' polynomials and the variational equations are judged.
struct TangentCheck {
    /// Of rates, which is allowed in any case.
    static constexpr double round_off = 1e4 * 0x1p-53;
    /// What is left out falls with a high power of the step. What does not is the round-off of derivatives that have
    /// only begun to differ from zero: no shorter step would be better. So many halvings have to gain so much.
    static constexpr int most_halvings = 8;
    static constexpr double least_gain = 0.1;
};

/// How far the series of derivatives may be followed: the last two terms of each must stay below a tolerance relative
/// to its first three, as for the states themselves. A motion may be much slower than what disturbs it, such as an
/// oscillation that follows a slow force: then steps that are right for the states are too long for their derivatives.
/// @param tolerance of the derivatives: the last two terms are some orders of magnitude larger than what is cut off
/// @return the step itself, or less
double tangent_reach(const TangentSeries& series, double tolerance, double step, const TangentFloors& floors);

/// Derivatives along a step and where a part of it ends.
struct TangentPlaces {
    const TangentSeries& here;
    const TangentSeries& there;            ///< begun at the end
    std::span<const double> sums, slopes;  ///< of the polynomials there, [state * width + direction]
    std::size_t states, count;             ///< directions that are in use
    std::function<void(double step)> look; ///< begins `there`, and finds sums and slopes, at the end of another part
};

/// Follows the series of derivatives for a step, or for a part of it over which their polynomials are what the
/// variational equations say at the end, as StepCheck asks of states.
/// @param tolerance that derivatives are allowed; @param noise by how much round-off may change rates, asked for only
/// where they differ from slopes, as floors are
/// @return the step, or the part; sums are those at its end. NaN where derivatives are not finite
double follow_tangents(const TangentPlaces& places, double tolerance, double step, const TangentFloors& floors,
                       const TangentFloors& noise);

} // namespace graze
