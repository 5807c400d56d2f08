#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Test of whether the residuals of an estimate are random noise. Confidence intervals assume noise that is independent
/// from reading to reading; with any other residuals they are too narrow or misplaced.
struct ResidualTest {
    double deviation = 0;   ///< root mean square of the residuals
    double correlation = 0; ///< correlation of neighbouring residuals
    /// Reasons why the residuals are not random noise, in words; empty: no test fails.
    std::vector<std::string> reasons;
    /// Factor for the standard errors where the residuals are not random but tiny (round-off, steps of a converter):
    /// they only limit the accuracy of the estimate, and in the worst case all act in the same direction.
    double widening = 1;

    bool is_noise() const { return reasons.empty(); }
    /// Returns the reasons in one line.
    std::string text() const;
};

/// Tests residuals in the order of time: the correlation of neighbours, and the number of runs of equal sign (A. Wald
/// and J. Wolfowitz, Ann. Math. Stat. 11 (1940) 147), both at four standard deviations; the largest line of the
/// periodogram (R. A. Fisher, Proc. R. Soc. A 125 (1929) 54), at a level of 1e-5; outliers beyond six standard
/// deviations, estimated from the median; if readings are given, the ratio of the residuals' sizes in the two halves,
/// at four standard deviations, and readings at the limits of the range, as where an instrument clips them.
/// @param left residuals, readings less fitted values
/// @param readings as many as residuals; empty: clipping and changes of size are not tested
/// @throws InputError when the sizes differ, or a number is not finite
ResidualTest test_residuals(std::span<const double> left, std::span<const double> readings = {});

/// Returns how many readings equal the smallest or the largest one, if these are far more than at the next value;
/// otherwise 0.
std::size_t clipped_readings(std::span<const double> readings);

/// Returns the p value of an F test: the probability that `further` columns reduce the residuals this much if they have
/// no influence.
/// @param left residuals of a least-squares fit; @param columns of that fit, and `further` ones, all as long as `left`
/// @return 1 when there are too few residuals, or when no further column is independent of `columns`
double chance_of_fit(std::span<const double> left, const std::vector<std::vector<double>>& columns,
                     const std::vector<std::vector<double>>& further);

} // namespace graze
