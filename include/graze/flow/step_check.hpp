#pragma once

#include "graze/flow/system.hpp"
#include "graze/tape/series.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Checks steps before they are accepted: at the end of a step the slopes of the states' polynomials must equal the
/// rates there, and the polynomials of event functions and observed expressions the values of these functions.
///
/// This check is needed because the last coefficients, from which steps are chosen, may vanish (x^5 at x = 0, cos(s^3)
/// at s = 0) or the function may not be analytic farther on. The slope of the polynomial of degree n less the vector
/// field is (n + 1) times the first truncated term, divided by the time; `allowance` accounts for this factor.
/// (n + 1) times the first term left out, divided by the time: a factor that `allowance` leaves room for.
class StepCheck {
public:
    /// Allowed differences of rates and of values, in units of the tolerance. For a step chosen from the last
    /// coefficients, rates usually differ by a few tolerances, values by a fraction of one.
    static constexpr double allowance = 20, value_allowance = 4;
    /// Squares of smaller numbers vanish or have few digits.
    static constexpr double smallest_size = 1e-150;
    /// Returns the size of a state by which its rates are judged, over a step of length h.
    /// @param start, start_rate, end, end_rate the state and its rate at both ends
    static double size_over(double start, double start_rate, double end, double end_rate, double h) {
        return smallest_size + std::max(std::abs(start), std::abs(end)) +
               0.25 * h * std::max(std::abs(start_rate), std::abs(end_rate));
    }

    StepCheck(const System& system, int order, double tolerance);
    /// @param parameters one for each parameter of the model
    void set_parameters(std::span<const double> parameters);

    /// Returns the longest part of a step for which the differences at the end are within the allowance: the step
    /// itself, a shorter one found by trial, or 0 if there is none. The allowance grows with the round-off, which is
    /// bounded by a running error analysis of the model's expressions.
    /// @param series of states, watched events and observed expressions of the mode
    /// @param length of the step, may be negative; @param inside whether to check two interior times too
    /// @param floors sizes below which series need not be resolved, one for each; or empty
    double longest(std::size_t mode, std::span<const Series> series, double length, bool inside,
                   std::span<const double> floors = {});

private:
    double misfit_of_rates(double s);
    double misfit_of_values(double s);
    double misfit_of_sums(double s);
    double size_of_state(std::size_t i, double s) const;
    void evaluate(std::size_t mode, double s);
    void find_errors(double s);

    System system_;
    std::size_t states_, order_, mode_ = 0;
    bool errors_known_ = false;
    double tolerance_;
    std::span<const Series> series_;
    std::span<const double> floors_;
    std::vector<double> inputs_, input_errors_, truth_, errors_, work_, slopes_;
    std::vector<double> seen_; ///< sizes, in rejected attempts, of states that start from zero
};

} // namespace graze
