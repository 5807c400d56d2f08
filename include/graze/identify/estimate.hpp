#pragma once

#include <cstddef>
#include <span>

namespace graze {

/// A number estimated from measurements, with its standard error.
struct Estimate {
    double value = 0;
    double error = 0;   ///< standard error
    double freedom = 0; ///< degrees of freedom of the error; 0: the error is unknown

    /// Half width of the confidence interval at a given probability, by Student's distribution; 0 when `freedom` is 0.
    /// @param probability of covering the true value, above 0 and below 1
    double half_width(double probability = 0.95) const;
};

/// Returns the t for which a variable of Student's distribution has |t'| > t with probability 1 - `probability`.
/// @param freedom positive, need not be an integer
double student_quantile(double probability, double freedom);

/// Returns the probability that an F variable (ratio of mean squares with `first` and `second` degrees of freedom)
/// exceeds `ratio`.
/// @param ratio not negative; both degrees of freedom must be positive
double fisher_tail(double ratio, double first, double second);

/// Returns the probability that a chi-square variable with `freedom` degrees of freedom exceeds `squares` (1 for 0
/// degrees of freedom).
/// @param squares not negative
double chi_square_tail(double squares, std::size_t freedom);

/// The mean of several estimates of one number, and how much the number itself varies between them.
struct Combined {
    Estimate mean;
    double spread = 0; ///< standard deviation of the number itself between sets, in excess of the sets' errors
};

/// Combines estimates that may differ by more than their errors, as where conditions change from set to set (random
/// effects). Weights are those of R. DerSimonian and N. Laird (Controlled Clin. Trials 7 (1986) 177), the error that of
/// J. Hartung and G. Knapp (Stat. Med. 20 (2001) 1771), though not below what the sets' own errors give. A single set
/// is returned unchanged.
/// @throws InputError when `sets` is empty
Combined combine(std::span<const Estimate> sets);

} // namespace graze
