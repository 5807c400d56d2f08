#pragma once

#include <cstddef>
#include <span>

namespace graze {

/// A number found from measurements, with what is known of its error.
struct Estimate {
    double value = 0;
    double error = 0;   ///< standard error
    double freedom = 0; ///< degrees of freedom with which the error is known; 0: it is not known at all

    /// Half of the interval that covers the truth with a probability, by Student's distribution. 0 without freedom.
    /// @param probability above 0 and below 1
    double half_width(double probability = 0.95) const;
};

/// Student's distribution: the t that a variable exceeds on either side with probability 1 - `probability` in all.
/// @param freedom positive, whole or not
double student_quantile(double probability, double freedom);

/// Fisher's distribution: the chance that a ratio of mean squares with `first` and `second` degrees of freedom is
/// larger.
/// @param ratio not negative; freedoms positive
double fisher_tail(double ratio, double first, double second);

/// Estimates of one number from several sets of measurements.
struct Combined {
    Estimate mean;
    double spread = 0; ///< standard deviation of the number itself from set to set, beyond what errors explain
};

/// The mean of sets that may differ by more than their errors, as where conditions change from set to set: weights are
/// those of R. DerSimonian and N. Laird (Controlled Clin. Trials 7 (1986) 177), the error that of J. Hartung and G.
/// Knapp (Stat. Med. 20 (2001) 1771), though not below what the sets' own errors say. Of one set it is that set.
/// @throws InputError when there is none
Combined combine(std::span<const Estimate> sets);

} // namespace graze
