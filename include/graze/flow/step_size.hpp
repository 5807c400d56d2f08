#pragma once

#include "graze/tape/series.hpp"

#include <cstddef>
#include <span>

namespace graze {

/// Tolerances that can be asked for. Below the lower one, round-off rules.
inline constexpr double smallest_tolerance = 1e-16;
inline constexpr double largest_tolerance = 1e-2;

/// The order at which a step costs least per unit of time for a relative error of `tolerance`:
/// 1 - 0.55 ln(tolerance), rounded up, from 4 to 20. (1 - ln(tolerance) / 2 is best where the work of a step grows with
/// the square of its order, Jorba and Zou 2005, section 3.2; here it grows a little less.)
/// @throws InputError unless the tolerance is positive; one that is out of range counts as the nearest within
int order_for_tolerance(double tolerance);
/// @throws InputError unless the order is one that steps can have
void require_order(int order);
/// @throws InputError unless the tolerance is positive
void require_tolerance(double tolerance);

/// Chooses steps from the last two coefficients of each state (Jorba and Zou 2005), each state being measured
/// by its own size over the step, so that units and magnitudes of different states do not matter.
class StepSize {
public:
    /// @throws InputError for an order or tolerance that steps cannot have
    StepSize(int order, double tolerance);

    /// @param states order + 1 coefficients of each
    /// @param previous the last step, for the size of states that are momentarily zero; 0 when there is none
    /// @return the step; infinity when nothing changes; NaN when a coefficient is
    ///         not finite
    double operator()(std::span<const Series> states, double previous) const;

    /// The same where states are allowed not to be known to less than a size of their own, and nothing is made of how
    /// their terms grow: close to a multiple zero, which relative accuracy would never let a trajectory reach.
    /// @param floors one for each state
    double with_floors(std::span<const Series> states, double previous, std::span<const double> floors) const;
    /// Sum of the first terms of a series at s = reference, or of all if those are zero.
    double size_of(const Series& c, double reference) const;

    /// Estimate of the radius of convergence, from the last coefficients (for reporting singularities).
    double radius(std::span<const Series> states) const;

    /// To base 2.
    double log_tolerance() const { return log_tolerance_; }
    int order() const { return static_cast<int>(order_); }

private:
    /// For a state that is a polynomial of lower degree, any step is exact: one over which it changes by about its
    /// own size keeps sizes meaningful (they are what round-off is measured by).
    double polynomial_step(const Series& c, double size) const;
    double step_for(std::span<const Series> states, double reference) const;
    double logarithm_of_change(const Series& c, double known) const;

    std::size_t order_;
    double log_tolerance_;
};

} // namespace graze
