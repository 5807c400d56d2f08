#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace graze {

/// Whether what an estimate leaves of readings is noise. Intervals are made for noise that is independent from reading
/// to reading; of anything else they are too narrow, and lie elsewhere.
struct ResidualTest {
    double deviation = 0;             ///< root of the mean of the squares
    double correlation = 0;           ///< of neighbours
    std::vector<std::string> reasons; ///< why it is no noise, in words; empty: it may be noise
    /// By which standard errors are to be multiplied where what is left is no noise, but so small (round-off, steps of
    /// a converter) that it only limits how well the estimate is known: all of it may point the same way.
    double widening = 1;

    bool is_noise() const { return reasons.empty(); }
    /// The reasons in one line.
    std::string text() const;
};

/// Tests residuals in the order of time: the correlation of neighbours, and the number of runs of one sign (A. Wald and
/// J. Wolfowitz, Ann. Math. Stat. 11 (1940) 147), both to four standard deviations; the largest line of the periodogram
/// (R. A. Fisher, Proc. R. Soc. A 125 (1929) 54), to one chance in 10^5; residuals beyond six standard deviations, by
/// their median; the size in the first half over that in the second, of residuals that are given with their readings,
/// to four standard deviations; and readings that stand at the end of their range, as where an instrument clips them.
/// @param left readings less what they should be
/// @param readings the same number of them; empty: nothing is said about clipping
/// @throws InputError when the numbers of readings differ, or a number is not finite
ResidualTest test_residuals(std::span<const double> left, std::span<const double> readings = {});

/// How many readings stand at the least or greatest value of all of them, far more than beside it; 0: no more.
std::size_t clipped_readings(std::span<const double> readings);

/// The chance that what is left falls by as much as it does when further columns may explain it, if there is nothing
/// in them: an F test.
/// @param left residuals of a fit by least squares; @param columns of that fit, and `further` ones, of the same length
/// @return 1 when there are too few residuals to tell, or none of the further columns is independent
double chance_of_fit(std::span<const double> left, const std::vector<std::vector<double>>& columns,
                     const std::vector<std::vector<double>>& further);

} // namespace graze
