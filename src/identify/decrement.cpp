#include "graze/identify/decrement.hpp"

#include "graze/symbolic/input_error.hpp"
#include "graze/symbolic/require.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze {

namespace {

void require_peaks(std::span<const DecayPeaks> releases) {
    bool enough = false;
    for (const DecayPeaks& peaks : releases) {
        require_size(peaks.heights.size(), peaks.times.size(), "heights of peaks");
        require_finite(peaks.times, "the time of a peak");
        require_finite(peaks.heights, "the height of a peak");
        enough = enough || peaks.times.size() > 2;
        if (peaks.times.size() < 2 ||
            std::any_of(peaks.heights.begin(), peaks.heights.end(), [](double h) { return !(h > 0); }) ||
            !std::is_sorted(peaks.times.begin(), peaks.times.end(), std::less_equal<>()))
            throw InputError("these are no peaks of an oscillation that dies out",
                             "give two or more of each release, with positive heights, in the order of time");
    }
    if (!enough)
        throw InputError("there are too few peaks to tell their errors", "give three or more of a release");
}

/// Lines of one slope and intercepts of their own over 0, 1, 2, ...
struct CommonSlope {
    double slope = 0, error = 0;
    std::vector<double> intercepts;
    std::vector<double> by_rest; ///< what the slope of the logarithms gains by each release's rest position
};

CommonSlope common_slope(std::span<const DecayPeaks> releases, const std::vector<std::vector<double>>& values,
                         double freedom) {
    double xx = 0, xy = 0;
    std::vector<double> mean_x, mean_y;
    for (std::size_t r = 0; r < releases.size(); ++r) {
        double weights = 0, x = 0, y = 0;
        for (std::size_t k = 0; k < values[r].size(); ++k) {
            const double weight = std::pow(releases[r].heights[k], 2);
            weights += weight;
            x += weight * static_cast<double>(k);
            y += weight * (values[r][k] - values[r].front());
        }
        mean_x.push_back(x / weights);
        mean_y.push_back(values[r].front() + y / weights);
        for (std::size_t k = 0; k < values[r].size(); ++k) {
            const double weight = std::pow(releases[r].heights[k], 2), from = static_cast<double>(k) - mean_x[r];
            xx += weight * from * from;
            xy += weight * from * (values[r][k] - mean_y[r]);
        }
    }
    CommonSlope line;
    line.slope = xy / xx;
    double squares = 0;
    for (std::size_t r = 0; r < releases.size(); ++r) {
        line.intercepts.push_back(mean_y[r] - line.slope * mean_x[r]);
        for (std::size_t k = 0; k < values[r].size(); ++k)
            squares += std::pow(
                releases[r].heights[k] * (values[r][k] - line.intercepts[r] - line.slope * static_cast<double>(k)), 2);
    }
    line.error = std::sqrt(squares / freedom / xx);
    for (std::size_t r = 0; r < releases.size(); ++r) {
        double change = 0; // of a logarithm -1/height, by weights of height^2
        for (std::size_t k = 0; k < values[r].size(); ++k)
            change -= releases[r].heights[k] * (static_cast<double>(k) - mean_x[r]);
        line.by_rest.push_back(change / xx);
    }
    return line;
}

} // namespace

Decrement logarithmic_decrement(std::span<const DecayPeaks> releases) {
    require_peaks(releases);
    std::vector<std::vector<double>> times, logarithms;
    double count = 0;
    for (const DecayPeaks& peaks : releases) {
        times.push_back(peaks.times);
        std::vector<double>& line = logarithms.emplace_back();
        for (const double height : peaks.heights)
            line.push_back(std::log(height));
        count += static_cast<double>(peaks.times.size());
    }
    const double freedom = count - static_cast<double>(releases.size()) - 1;
    CommonSlope decay = common_slope(releases, logarithms, freedom);
    const CommonSlope period = common_slope(releases, times, freedom);
    for (std::size_t r = 0; r < releases.size(); ++r)
        decay.error = std::hypot(decay.error, decay.by_rest[r] * releases[r].rest_error);
    const double turn = 2 * std::numbers::pi, decrement = -decay.slope, size = std::hypot(turn, decrement);
    Decrement result;
    result.damping = {decrement / size, decay.error * turn * turn / std::pow(size, 3), freedom};
    result.frequency = {size / period.slope,
                        std::hypot(decay.error * decrement / size, period.error * size / period.slope) / period.slope,
                        freedom};
    double pairs = 0;
    for (std::size_t r = 0; r < releases.size(); ++r) {
        DecayPeaks& fitted = result.fitted.emplace_back();
        for (std::size_t k = 0; k < times[r].size(); ++k) {
            fitted.times.push_back(period.intercepts[r] + period.slope * static_cast<double>(k));
            fitted.heights.push_back(std::exp(decay.intercepts[r] + decay.slope * static_cast<double>(k)));
            if (k == 0)
                continue;
            const double own = logarithms[r][k - 1] - logarithms[r][k];
            result.pair_damping += own / std::hypot(turn, own);
            result.pair_frequency += std::hypot(turn, own) / (times[r][k] - times[r][k - 1]);
            ++pairs;
        }
    }
    result.pair_damping /= pairs;
    result.pair_frequency /= pairs;
    return result;
}

} // namespace graze
