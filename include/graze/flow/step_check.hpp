#pragma once

#include "graze/flow/system.hpp"
#include "graze/tape/series.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// What a step must show before it is believed: at its end the slopes of the states' polynomials are the rates there,
/// and the polynomials of event functions and observed expressions have the values of these.
///
/// The last coefficients, from which steps are chosen, say nothing where they vanish (x^5 at x = 0, cos(s^3) at s = 0)
/// or where what comes is not analytic in sight. The slope of the polynomial of degree n, less the vector field, is
/// (n + 1) times the first term left out, divided by the time: a factor that `allowance` leaves room for.
class StepCheck {
public:
    /// What is allowed of the tolerance. Over a step that is chosen from the last coefficients, rates differ by a few
    /// tolerances, values by a fraction of one.
    static constexpr double allowance = 20, value_allowance = 4;
    /// Squares of what is smaller vanish or have few digits.
    static constexpr double smallest_size = 1e-150;
    /// The size of a state by which its rates are judged, over a step of length h.
    /// @param start, start_rate, end, end_rate the state there, and its rate
    static double size_over(double start, double start_rate, double end, double end_rate, double h) {
        return smallest_size + std::max(std::abs(start), std::abs(end)) +
               0.25 * h * std::max(std::abs(start_rate), std::abs(end_rate));
    }

    StepCheck(const System& system, int order, double tolerance);
    /// @param parameters as many as the model has
    void set_parameters(std::span<const double> parameters);

    /// The longest part of a step at whose end the differences are as allowed: the step itself, or a shorter one found
    /// by trial; 0 if there is none. More is allowed where round-off makes it (bounded by a running error analysis of
    /// the model's expressions).
    /// @param series of states, watched events and observed expressions of the mode
    /// @param length of the step, also negative; @param inside whether to look at two times within as well
    /// @param floors sizes below which series need not be known, one for each; or none
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
    std::vector<double> seen_; ///< sizes that states without a size of their own had in refused attempts
};

} // namespace graze
