#include "graze/identify/residual_test.hpp"

#include "base/linear_systems.hpp"
#include "base/median.hpp"
#include "graze/base/require.hpp"
#include "graze/identify/estimate.hpp"
#include "record/fourier.hpp"

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace graze {

namespace {

constexpr double significant_deviations = 4; ///< a level of 1/16,000 for normal variables
constexpr double small_chance = 1e-5;        ///< level for the largest line of the periodogram
constexpr std::size_t fewest_residuals = 12; ///< fewer residuals are not tested
constexpr double far_off = 6;                ///< outliers, in standard deviations
constexpr double negligible_residual = 1e-6; ///< smaller residuals, relative to the readings' deviation, are ignored

double square_sum_of(std::span<const double> values) {
    return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

/// Correlation of neighbouring residuals, about zero.
double neighbours_correlation(std::span<const double> left) {
    const double products = std::inner_product(left.begin() + 1, left.end(), left.begin(), 0.0),
                 squares = square_sum_of(left);
    return squares > 0 ? products / squares : 0;
}

/// Number of standard deviations by which runs of equal sign are fewer than expected by chance.
double missing_runs(std::span<const double> left) {
    double positive = 0, negative = 0, runs = 0;
    int before = 0;
    for (const double value : left) {
        const int sign = value > 0 ? 1 : value < 0 ? -1 : 0;
        if (sign == 0)
            continue;
        (sign > 0 ? positive : negative) += 1;
        runs += sign != before ? 1 : 0;
        before = sign;
    }
    const double count = positive + negative, pairs = 2 * positive * negative;
    if (!(positive > 0) || !(negative > 0))
        return count > static_cast<double>(fewest_residuals) ? std::sqrt(count) : 0;
    const double mean = pairs / count + 1, variance = pairs * (pairs - count) / (count * count * (count - 1));
    return variance > 0 ? (mean - runs) / std::sqrt(variance) : 0;
}

/// A line of the periodogram.
struct Line {
    std::size_t number = 0; ///< cycles within all residuals
    double height = 0;      ///< power relative to the mean of all lines
};

Line largest_line(std::span<const double> left) {
    const auto transform = half_transform(left);
    std::size_t highest = 0;
    double sum = 0, largest = 0;
    for (std::size_t k = 1; k < transform.size(); ++k) {
        const double size = std::norm(transform[k]);
        sum += size;
        highest = size > largest ? k : highest;
        largest = std::max(largest, size);
    }
    return {highest, sum > 0 ? largest / sum * static_cast<double>(transform.size() - 1) : 0};
}

std::size_t count_far_off(std::span<const double> left) {
    std::vector<double> sizes(left.begin(), left.end());
    for (double& size : sizes)
        size = std::abs(size);
    constexpr double of_normal = 1.4826;
    // The median of few readings is itself uncertain.
    const double limit = far_off * (1 + 2 / std::sqrt(static_cast<double>(left.size()))) * of_normal * median(sizes);
    return limit > 0 ? static_cast<std::size_t>(
                           std::count_if(sizes.begin(), sizes.end(), [&](double size) { return size > limit; }))
                     : 0;
}

/// Step of a converter: the smallest difference of readings, if most values occur more than once; otherwise 0.
double step_of(std::vector<double> readings) {
    std::sort(readings.begin(), readings.end());
    double step = std::numeric_limits<double>::infinity();
    std::size_t distinct = readings.empty() ? 0 : 1;
    for (std::size_t i = 1; i < readings.size(); ++i)
        if (readings[i] > readings[i - 1]) {
            ++distinct;
            step = std::min(step, readings[i] - readings[i - 1]);
        }
    return 2 * distinct < readings.size() && std::isfinite(step) ? step : 0;
}

/// Counts readings that differ from the one before. Rounding errors of equal neighbours are not independent.
double changes_of(std::span<const double> readings) {
    double changes = 1;
    for (std::size_t i = 1; i < readings.size(); ++i)
        changes += readings[i] != readings[i - 1] ? 1 : 0;
    return changes;
}

double deviation_of(std::span<const double> readings) {
    double mean = 0, squares = 0;
    for (const double value : readings)
        mean += value / static_cast<double>(readings.size());
    for (const double value : readings)
        squares += (value - mean) * (value - mean);
    return std::sqrt(squares / static_cast<double>(readings.size()));
}

/// Ratio of the residuals' root mean squares in the first and the second half; 1 if chance explains it, for noise with
/// the measured kurtosis.
double change_of_size(std::span<const double> left) {
    const std::size_t half = left.size() / 2;
    const std::span<const double> parts[] = {left.first(half), left.subspan(half)};
    double logarithm = 0, variance = 0, sign = 1;
    for (const std::span<const double> part : parts) {
        const auto count = static_cast<double>(part.size());
        const double square = square_sum_of(part) / count;
        if (!(square > 0))
            return 1;
        double fourth = 0;
        for (const double value : part)
            fourth += value * value * value * value / (count * square * square);
        constexpr double of_normal = 3;
        logarithm += sign * std::log(square);
        variance += (std::max(fourth, of_normal) - 1) / count;
        sign = -sign;
    }
    return std::abs(logarithm) > significant_deviations * std::sqrt(variance) ? std::exp(0.5 * logarithm) : 1;
}

std::vector<std::string> reasons_of(std::span<const double> left, double correlation) {
    std::vector<std::string> reasons;
    const auto count = static_cast<double>(left.size());
    if (std::abs(correlation) * std::sqrt(count) > significant_deviations)
        reasons.push_back(fmt::format("neighbouring residuals have a correlation of {:.2g}", correlation));
    if (const double missing = missing_runs(left); missing > significant_deviations)
        reasons.emplace_back("residuals keep their sign too long");
    const Line line = largest_line(left);
    if (line.height > std::log(0.5 * count / small_chance))
        reasons.push_back(line.number <= 2 ? std::string("residuals drift")
                                           : fmt::format("residuals have a wave of {} cycles", line.number));
    if (const std::size_t far = count_far_off(left); far > 0)
        reasons.push_back(
            fmt::format("{} of {} readings are more than {} standard deviations off", far, left.size(), far_off));
    return reasons;
}

} // namespace

std::string ResidualTest::text() const {
    return fmt::format("{}", fmt::join(reasons, "; "));
}

std::size_t clipped_readings(std::span<const double> readings) {
    constexpr std::size_t least = 5, times = 5;
    constexpr std::size_t flat =
        3; // consecutive: with a whole number of samples a period each peak repeats its reading, but not consecutively
    std::size_t clipped = 0;
    for (const double sign : {1.0, -1.0}) {
        double most = -std::numeric_limits<double>::infinity(), next = most;
        std::size_t at_most = 0, at_next = 0, in_a_row = 0, longest = 0;
        for (const double value : readings) {
            const double one = sign * value;
            if (one > most) {
                next = most;
                at_next = at_most;
                most = one;
                at_most = in_a_row = longest = 0;
            } else if (one > next && one < most) {
                next = one;
                at_next = 0;
            }
            at_most += one == most ? 1 : 0;
            at_next += one == next ? 1 : 0;
            in_a_row = one == most ? in_a_row + 1 : 0;
            longest = std::max(longest, in_a_row);
        }
        if (longest >= flat && at_next > 0 && at_most >= least && at_most > times * at_next)
            clipped += at_most;
    }
    return clipped;
}

ResidualTest test_residuals(std::span<const double> left, std::span<const double> readings) {
    require_finite(left, "a residual");
    if (!readings.empty())
        require_size(readings.size(), left.size(), "readings");
    ResidualTest test;
    if (left.size() < fewest_residuals)
        return test;
    const auto count = static_cast<double>(left.size());
    test.deviation = std::sqrt(square_sum_of(left) / count);
    if (!(test.deviation > 0))
        return test;
    test.correlation = neighbours_correlation(left);
    test.reasons = reasons_of(left, test.correlation);
    constexpr double of_step = 0.6; // independent rounding errors have 0.29
    const bool rounded = !readings.empty() && test.deviation <= of_step * step_of({readings.begin(), readings.end()});
    const bool small = rounded || (!readings.empty() && test.deviation <= negligible_residual * deviation_of(readings));
    if (small && !test.reasons.empty()) {
        test.reasons.clear();
        test.widening = std::sqrt(count);
    } else if (rounded) {
        test.widening = std::sqrt(count / changes_of(readings));
    }
    // Rounding errors depend on the motion, so their size may change.
    if (const double change = change_of_size(left); change != 1 && !small && !readings.empty())
        test.reasons.push_back(
            fmt::format("residuals are {:.2g} times as large in the first half as in the second, as with a clock "
                        "that jitters",
                        change));
    if (const std::size_t clipped = clipped_readings(readings); clipped > 0)
        test.reasons.push_back(
            fmt::format("{} readings stand at the end of their range, as if they were clipped", clipped));
    return test;
}

double chance_of_fit(std::span<const double> left, const std::vector<std::vector<double>>& columns,
                     const std::vector<std::vector<double>>& further) {
    const auto rows = static_cast<Eigen::Index>(left.size());
    const auto matrix_of = [&](const std::vector<std::vector<double>>& given) {
        Eigen::MatrixXd matrix(rows, static_cast<Eigen::Index>(given.size()));
        for (std::size_t c = 0; c < given.size(); ++c) {
            require_size(given[c].size(), left.size(), "numbers of a column");
            matrix.col(static_cast<Eigen::Index>(c)) = Eigen::Map<const Eigen::VectorXd>(given[c].data(), rows);
        }
        for (Eigen::Index c = 0; c < matrix.cols(); ++c)
            if (const double length = matrix.col(c).norm(); length > 0)
                matrix.col(c) /= length;
        return matrix;
    };
    const Eigen::VectorXd right = Eigen::Map<const Eigen::VectorXd>(left.data(), rows);
    const Eigen::MatrixXd own = matrix_of(columns);
    const PivotedQR first(own);
    const Eigen::VectorXd rest = right - own * first.solve(right);
    Eigen::MatrixXd more = matrix_of(further);
    more -= own * first.solve_columns(more);
    constexpr double independent = 1e-4;
    std::vector<Eigen::Index> kept; // columns that are independent of the fit's own
    for (Eigen::Index c = 0; c < more.cols(); ++c)
        if (more.col(c).norm() > independent)
            kept.push_back(c);
    if (kept.empty())
        return 1;
    Eigen::MatrixXd used(rows, static_cast<Eigen::Index>(kept.size()));
    for (std::size_t c = 0; c < kept.size(); ++c)
        used.col(static_cast<Eigen::Index>(c)) = more.col(kept[c]);
    const PivotedQR second(used, independent);
    const auto rank = static_cast<double>(second.rank());
    const double freedom = static_cast<double>(rows - own.cols()) - rank;
    const double before = rest.squaredNorm(), after = (rest - used * second.solve(rest)).squaredNorm();
    if (!(freedom >= 2) || !(before > 0))
        return 1;
    if (!(after > 0))
        return 0;
    return fisher_tail((before - after) / rank / (after / freedom), rank, freedom);
}

} // namespace graze
