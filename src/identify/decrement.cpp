#include "graze/identify/decrement.hpp"

#include "graze/record/period.hpp"
#include "graze/symbolic/input_error.hpp"
#include "graze/symbolic/require.hpp"
#include "record/local_polynomial.hpp"

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
    const CommonSlope decay = common_slope(releases, logarithms, freedom),
                      period = common_slope(releases, times, freedom);
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

namespace {

/// A polynomial near a peak, and where its top is.
struct PeakFit {
    double time = 0, middle = 0, width = 1;
    std::vector<double> powers{};

    double height(double t) const {
        const double x = (t - middle) / width;
        double sum = 0;
        for (std::size_t k = powers.size(); k-- > 0;)
            sum = sum * x + powers[k];
        return sum;
    }
};

/// That of the samples around the highest one of a period. @return whether it has a top
bool fit_peak(const Period& period, std::size_t channel, PeakFit& peak) {
    const std::vector<double>&times = period.samples.times, &values = period.samples.values[channel];
    std::size_t highest = 0;
    for (std::size_t i = 0; i < times.size(); ++i)
        if (times[i] >= period.begin && times[i] <= period.end && values[i] > values[highest])
            highest = i;
    // Noise moves the highest sample; the middle of what is nearly as high is not moved so far.
    constexpr double nearly = 0.8, reach = 0.15;
    std::size_t first = highest, last = highest;
    while (first > 0 && values[first - 1] > nearly * values[highest])
        --first;
    while (last + 1 < values.size() && values[last + 1] > nearly * values[highest])
        ++last;
    const double middle = 0.5 * (times[first] + times[last]), width = reach * period.duration();
    std::vector<double> places, heights;
    for (std::size_t i = 0; i < times.size(); ++i)
        if (std::abs(times[i] - middle) <= width) {
            places.push_back((times[i] - middle) / width);
            heights.push_back(values[i]);
        }
    constexpr std::size_t eighth = 8, fewest = 4;
    if (places.size() < fewest)
        return false;
    const LocalPolynomial fit(places, std::min(eighth, places.size() / 2));
    const std::vector<double> powers = fit.powers(heights.data());
    double x = 0;
    constexpr int steps = 50;
    for (int i = 0; i < steps; ++i) { // Newton's method for the slope
        double slope = 0, bend = 0;
        for (std::size_t k = powers.size(); k-- > 1;) {
            bend = bend * x + slope;
            slope = slope * x + static_cast<double>(k) * powers[k];
        }
        if (!(bend < 0))
            return false;
        const double change = -slope / bend;
        x = std::clamp(x + change, -1.0, 1.0);
        if (std::abs(change) < 1e-15)
            break;
    }
    peak.middle = middle;
    peak.width = width;
    peak.powers = powers;
    peak.time = middle + width * x;
    return std::abs(x) < 1;
}

/// The heights are those at times as far from one another as all of them say: at its own top each polynomial is too
/// high by what noise has moved the top, and the lower the peak the more.
DecayPeaks at_common_times(const std::vector<PeakFit>& fits) {
    double weights = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t k = 0; k < fits.size(); ++k) {
        const double weight = std::pow(fits[k].height(fits[k].time), 2);
        weights += weight;
        x += weight * static_cast<double>(k);
        y += weight * fits[k].time;
    }
    x /= weights;
    y /= weights;
    for (std::size_t k = 0; k < fits.size(); ++k) {
        const double weight = std::pow(fits[k].height(fits[k].time), 2), from = static_cast<double>(k) - x;
        xx += weight * from * from;
        xy += weight * from * (fits[k].time - y);
    }
    DecayPeaks peaks;
    for (std::size_t k = 0; k < fits.size(); ++k) {
        peaks.times.push_back(fits[k].time);
        peaks.heights.push_back(fits[k].height(y + xy / xx * (static_cast<double>(k) - x)));
    }
    return peaks;
}

} // namespace

DecayPeaks decay_peaks(SampleSource& source, std::size_t channel, std::size_t most) {
    require_index(channel, source.header().channels.size(), "channel");
    PeriodSettings settings;
    settings.reference = channel;
    PeriodSplitter splitter(source, settings);
    std::vector<PeakFit> fits;
    PeakFit fit;
    for (Period period; fits.size() < most && splitter.next(period) && fit_peak(period, channel, fit);)
        fits.push_back(fit);
    if (fits.size() < 2)
        throw InputError(fmt::format("'{}' has fewer than two peaks", source.header().channels[channel].name),
                         "give the record of an oscillation about nought that dies out");
    return at_common_times(fits);
}

} // namespace graze
