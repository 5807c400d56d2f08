#pragma once

#include "graze/tape/series.hpp"

#include <cstddef>
#include <span>

namespace graze {

/// The range of tolerances. Below the smallest one round-off dominates.
inline constexpr double smallest_tolerance = 1e-16;
inline constexpr double largest_tolerance = 1e-2;

/// Returns the order at which a step costs least per unit of time for a relative error of `tolerance`: 1 - 0.55
/// ln(tolerance), rounded up, between 4 and 20. (1 - ln(tolerance) / 2 is optimal if the work of a step grows with the
/// square of its order, Jorba and Zou 2005, section 3.2; here it grows a little more slowly.)
/// @throws InputError unless the tolerance is positive; one out of range is replaced by the nearest in range
int order_for_tolerance(double tolerance);
/// @throws InputError unless the order is allowed
void require_order(int order);
/// @throws InputError unless the tolerance is positive
void require_tolerance(double tolerance);

/// Chooses steps from the last two coefficients of each state (Jorba and Zou 2005). Each state is measured by its own
/// size over the step, so that units and magnitudes of different states do not matter.
class StepSize {
public:
    /// @throws InputError for an order or tolerance out of range
    StepSize(int order, double tolerance);

    /// @param states order + 1 coefficients of each
    /// @param previous the last step, used for the size of states that are momentarily zero; 0 if there is none
    /// @return the step; infinity when nothing changes; NaN when a coefficient is not finite
    double operator()(std::span<const Series> states, double previous) const;

    /// The same, with states resolved only down to given sizes and without the condition that terms do not grow. This
    /// is used near a multiple zero of a state, which relative accuracy would never let a trajectory reach.
    /// @param floors smallest size to be resolved, one for each state
    double with_floors(std::span<const Series> states, double previous, std::span<const double> floors) const;
    /// Returns the sum of the sizes of the first three terms at s = reference, or of all terms if these are zero.
    double size_of(const Series& c, double reference) const;

    /// Estimates the radius of convergence from the last coefficients (for reports of singularities).
    double radius(std::span<const Series> states) const;

    /// Returns the logarithm of the tolerance to base 2.
    double log_tolerance() const { return log_tolerance_; }
    int order() const { return static_cast<int>(order_); }

private:
    /// A polynomial of lower degree is exact for any step: returns one over which it changes by about its own size, so
    /// that sizes, from which round-off is judged, stay meaningful.
    double polynomial_step(const Series& c, double size) const;
    double step_for(std::span<const Series> states, double reference) const;
    double logarithm_of_change(const Series& c, double known) const;

    std::size_t order_;
    double log_tolerance_;
};

} // namespace graze
