#pragma once

#include "tape/tangent_series.hpp"

#include <cstddef>
#include <functional>
#include <span>

namespace graze {

/// Returns the sizes below which derivatives need not be resolved, [state * width + direction]. Called only where the
/// derivatives' own sizes are too small to be useful.
using TangentFloors = std::function<std::span<const double>()>;

/// Constants for comparing slopes of derivatives' polynomials with the variational equations.
struct TangentCheck {
    /// Difference that is always allowed, relative to the rates.
    static constexpr double round_off = 1e4 * 0x1p-53;
    /// Truncation errors fall with a high power of the step. A difference that does not is round-off of derivatives
    /// that have only begun to differ from zero, which no shorter step reduces: this many halvings must reduce it by
    /// this factor.
    static constexpr int most_halvings = 8;
    static constexpr double least_gain = 0.1;
};

/// Returns the length for which the series of derivatives are accurate, at most `step`: the last two terms of each must
/// be below a tolerance relative to its first three, as for the states. A motion may be much slower than disturbances
/// of it, for example an oscillator that follows a slow force: steps that suit the states are then too long for
/// derivatives.
/// @param tolerance of the derivatives: the last two terms are some orders of magnitude larger than the truncation
/// error
/// @return the step itself, or a shorter one
double tangent_reach(const TangentSeries& series, double tolerance, double step, const TangentFloors& floors);

/// Derivatives along a step and at the end of a part of it.
struct TangentEndpoints {
    const TangentSeries& here;
    const TangentSeries& there;                   ///< with coefficients 0 and 1 at the end
    std::span<const double> sums, slopes;         ///< of the polynomials at the end, [state * width + direction]
    std::size_t states, count;                    ///< number of states, and of directions in use
    std::function<void(double step)> evaluate_at; ///< computes `there`, sums and slopes at the end of another part
};

/// Returns the length for which the polynomials of derivatives agree with the variational equations at the end, as
/// StepCheck does for states: the step, or a part of it.
/// @param tolerance of the derivatives; @param floors, noise called only where rates differ from slopes; `noise`
/// returns the changes of rates that round-off may cause
/// @return the length; sums are those at its end. NaN where derivatives are not finite
double follow_tangents(const TangentEndpoints& places, double tolerance, double step, const TangentFloors& floors,
                       const TangentFloors& noise);

} // namespace graze
