#include "graze/identify/decrement.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"

#include <Eigen/Dense>

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
            throw InputError("these are not peaks of a decaying oscillation",
                             "give two or more of each release, with positive heights, in the order of time");
    }
    if (!enough)
        throw InputError("there are too few peaks to determine standard errors", "give three or more of a release");
}

/// Straight lines with a common slope, and an intercept for each release, over the peak numbers 0, 1, 2, ...
struct CommonSlope {
    double slope = 0, error = 0;
    std::vector<double> intercepts;
    std::vector<double> by_rest; ///< derivative of the slope of the logarithms by each release's rest position
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
        double change = 0; // the derivative of a logarithm is -1/height, its weight height^2
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

DampedOscillation damped_oscillation(std::span<const DecayWave> releases) {
    if (releases.empty())
        throw InputError("there are no releases", "give one or more");
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Eigen::Vector2d weighted = Eigen::Vector2d::Zero();
    const auto point_of = [](const DecayWave& wave) { return Eigen::Vector2d(wave.turn, wave.decay); };
    std::vector<Eigen::Matrix2d> weights;
    double freedom = 0;
    for (const DecayWave& wave : releases) {
        for (const double value : {wave.turn, wave.decay, wave.turn_variance, wave.decay_variance, wave.covariance})
            require_finite(value, "a number of a wave");
        if (!(wave.turn > 0) || !(wave.freedom > 0))
            throw InputError("a wave has no frequency, or no samples", "give waves of decay_peaks");
        // Exact samples have zero errors: a floor at round-off then gives all waves equal weight.
        const double least = std::pow(1e-15 * wave.turn, 2);
        Eigen::Matrix2d covariance;
        covariance << wave.turn_variance + least, wave.covariance, wave.covariance, wave.decay_variance + least;
        weights.emplace_back(covariance.inverse());
        information += weights.back();
        weighted += weights.back() * point_of(wave);
        freedom += wave.freedom;
    }
    const Eigen::Matrix2d covariance = information.inverse();
    const Eigen::Vector2d mean = covariance * weighted;
    DampedOscillation result;
    if (releases.size() > 1) {
        double departures = 0;
        for (std::size_t r = 0; r < releases.size(); ++r) {
            const Eigen::Vector2d departure = point_of(releases[r]) - mean;
            departures += departure.dot(weights[r] * departure);
        }
        const double count = 2 * static_cast<double>(releases.size() - 1);
        result.chance = fisher_tail(departures / count, count, freedom);
    }
    const double size = mean.norm();
    const Eigen::Vector2d by_frequency = mean / size,
                          by_damping = Eigen::Vector2d(-mean[0] * mean[1], mean[0] * mean[0]) / std::pow(size, 3);
    result.frequency = {size, std::sqrt(by_frequency.dot(covariance * by_frequency)), freedom};
    result.damping = {mean[1] / size, std::sqrt(by_damping.dot(covariance * by_damping)), freedom};
    result.covariance = by_frequency.dot(covariance * by_damping);
    return result;
}

} // namespace graze
