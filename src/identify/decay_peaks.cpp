#include "graze/identify/decay_peaks.hpp"

#include "base/decompositions.hpp"
#include "base/median.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/record/period.hpp"
#include "graze/record/spectrum.hpp"
#include "identify/damped_sine.hpp"
#include "record/local_polynomial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace graze {

namespace {

constexpr std::size_t most_samples_of_decay = 10'000'000;

/// Estimate of the final position of a channel: its mean over the second half of the record.
double level_of(const std::vector<double>& values) {
    double sum = 0;
    const std::size_t first = values.size() / 2;
    for (std::size_t i = first; i < values.size(); ++i)
        sum += (values[i] - values[first]) / static_cast<double>(values.size() - first);
    return values[first] + sum;
}

/// Noise from second differences, which are small for a wave with many samples a period. Their median ignores jumps.
double noise_by_differences(const std::vector<double>& values) {
    std::vector<double> differences;
    for (std::size_t i = 1; i + 1 < values.size(); ++i)
        differences.push_back(std::abs(values[i + 1] - 2 * values[i] + values[i - 1]));
    constexpr double median_of_normal = 0.6745, squares = 6;
    return median(std::move(differences)) / (median_of_normal * std::sqrt(squares));
}

/// Noise from the linear recurrence that a damped sine obeys: a weighted sum of three neighbouring samples is constant,
/// however few samples a period has. The weights are those for which the sum varies least (V. F. Pisarenko, Geophys. J.
/// R. astr. Soc. 33 (1973) 347).
double noise_by_recurrence(const std::vector<double>& values) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    const auto three = [&](std::size_t i) { return Eigen::Vector3d(values[i - 1], values[i], values[i + 1]); };
    const auto count = static_cast<double>(values.size() - 2);
    for (std::size_t i = 1; i + 1 < values.size(); ++i)
        mean += three(i) / count;
    for (std::size_t i = 1; i + 1 < values.size(); ++i)
        squares += (three(i) - mean) * (three(i) - mean).transpose() / count;
    const auto variances = symmetric_eigenvalues(squares);
    return variances ? std::sqrt(std::max(0.0, (*variances)[0])) : std::numeric_limits<double>::infinity();
}

/// Standard deviation of the noise: the smaller of two estimates, as each takes what its own model does not describe
/// for noise.
double noise_of(const std::vector<double>& values) {
    constexpr std::size_t fewest = 10;
    if (values.size() < fewest)
        return 0;
    return std::min(noise_by_differences(values), noise_by_recurrence(values));
}

/// Moving average over a quarter of the period of the largest wave, so that noise does not create periods.
std::vector<double> smoothed(const Samples& samples, std::size_t channel, double level) {
    std::vector<double> values = samples.values[channel];
    for (double& value : values)
        value -= level;
    const Spectrum waves = spectrum(values, sampling_frequency(samples.times));
    const auto highest = std::max_element(waves.amplitudes.begin(), waves.amplitudes.end());
    const double period = 1 / waves.frequencies[static_cast<std::size_t>(highest - waves.amplitudes.begin())];
    constexpr double share = 0.125; // of a period, on each side
    const double rows = share * period * sampling_frequency(samples.times);
    const auto count = values.size();
    if (!(rows >= 1 && rows < static_cast<double>(count)))
        return samples.values[channel];
    const auto half = static_cast<std::size_t>(rows);
    std::vector<double> result(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t first = i - std::min(i, half), last = std::min(count - 1, i + half);
        for (std::size_t j = first; j <= last; ++j)
            result[i] += samples.values[channel][j] / static_cast<double>(last - first + 1);
    }
    return result;
}

/// Returns the recorded periods, from one rising crossing of the level to the next, up to `most`.
/// @param seen the samples in which crossings are looked for: the recorded ones, or smoothed ones
std::vector<Period> periods_above(double hysteresis, const Samples& seen, const Samples& samples,
                                  const RecordHeader& header, std::size_t channel, double level, std::size_t most) {
    StoredSamples source(header, seen);
    PeriodSplitter splitter(borrowed(source), {channel, level, hysteresis});
    std::vector<Period> periods;
    for (Period period; periods.size() < most && splitter.next(period);) {
        const auto row_of = [&](double time) {
            return static_cast<std::size_t>(std::lower_bound(samples.times.begin(), samples.times.end(), time) -
                                            samples.times.begin());
        };
        constexpr std::size_t margin = 3;
        const std::size_t first = row_of(period.begin), last = row_of(period.end);
        period.samples.clear(samples.values.size());
        period.samples.append(samples, first - std::min(first, margin), std::min(samples.rows(), last + margin));
        periods.push_back(std::move(period));
    }
    return periods;
}

/// Finds periods whose swing exceeds a tenth of the range. Strong damping leaves too few of them: then the threshold is
/// lowered step by step, down to the noise.
std::vector<Period> periods_of(const Samples& samples, const RecordHeader& header, std::size_t channel, double level,
                               std::size_t most) {
    Samples seen = samples;
    const auto range_of = [&](const Samples& some) {
        const auto [least, greatest] = std::minmax_element(some.values[channel].begin(), some.values[channel].end());
        return *greatest - *least;
    };
    constexpr double noisy = 0.02; // of the range: a fifth of the threshold of a crossing
    const double noise = noise_of(samples.values[channel]);
    if (noise > noisy * range_of(samples))
        seen.values[channel] = smoothed(samples, channel, level);
    const double range = range_of(seen);
    constexpr double usual = 0.1, smaller = 0.25, stands_out = 5, resolved = 1e-9;
    constexpr std::size_t enough = 3; // peaks that determine a standard error
    const double lowest = std::max(stands_out * noise, resolved * range);
    std::vector<Period> periods;
    for (double hysteresis = usual * range; hysteresis > 0; hysteresis *= smaller) {
        periods = periods_above(hysteresis, seen, samples, header, channel, level, most);
        if (periods.size() >= std::min(most, enough) || smaller * hysteresis < lowest)
            break;
    }
    return periods;
}

/// A polynomial fitted near a peak, in powers of (t - middle)/width, and the time of its maximum.
struct PeakFit {
    double time = 0, middle = 0, width = 1;
    double noise = 0; ///< standard error of the height
    std::vector<double> powers{};

    double height(double t) const { return polynomial_at(powers, (t - middle) / width); }
};

/// Smallest degree whose truncation error for a cosine is below the noise: a higher degree would follow the noise.
std::size_t powers_for(double noise_by_height) {
    // Error of Chebyshev's polynomials for a cosine over 0.15 of its period on each side of its maximum.
    constexpr std::pair<std::size_t, double> left[] = {{2, 4e-3}, {4, 3e-5}, {6, 1.2e-7}};
    constexpr double share = 0.1;
    for (const auto& [degree, error] : left)
        if (error < share * noise_by_height)
            return degree;
    return 8;
}

/// Shape of the fit, common to all peaks of a release, so that the truncation error is the same fraction of each peak.
/// If it were chosen peak by peak, later (noisier) peaks would come out lower and the damping too strong.
struct PeakShape {
    bool noisy = false; ///< noise dominates the highest sample, so a wider window is needed to see the curvature
    std::size_t degree = 2;
};

/// Chooses the shape for peaks between two heights. @param samples samples of the channel in about a third of a period
PeakShape shape_of(double highest, double lowest, double noise, double samples) {
    constexpr double much = 0.02;
    PeakShape shape;
    shape.noisy = noise > much * lowest;
    if (!shape.noisy) // then a parabola, whose truncation error is larger, would bias the peaks
        shape.degree = powers_for(noise / std::sqrt(std::max(1.0, samples)) / highest);
    return shape;
}

/// Fits the samples around the highest one of a period. @return whether they have a maximum that stands out from the
/// noise
bool fit_peak(const Period& period, std::size_t channel, const DecayFit& rest, const PeakShape& shape, PeakFit& peak) {
    const std::vector<double>&times = period.samples.times, &values = period.samples.values[channel];
    std::size_t highest = times.size();
    for (std::size_t i = 0; i < times.size(); ++i)
        if (times[i] >= period.begin && times[i] <= period.end &&
            (highest == times.size() || values[i] > values[highest]))
            highest = i;
    if (highest == times.size() || !(values[highest] > rest.value))
        return false;
    // Noise shifts the highest sample; the middle of the samples above 80 % of its height is shifted less.
    constexpr double share = 0.8, reach = 0.15;
    const double nearly = rest.value + share * (values[highest] - rest.value);
    std::size_t first = highest, last = highest;
    while (first > 0 && values[first - 1] > nearly)
        --first;
    while (last + 1 < values.size() && values[last + 1] > nearly)
        ++last;
    constexpr double wider = 0.25, fewest_within = 5;
    const double spacing =
        (times.back() - times.front()) / static_cast<double>(std::max<std::size_t>(2, times.size()) - 1);
    const bool wide = shape.noisy || 2 * reach * rest.distance < fewest_within * spacing;
    const double middle = shape.noisy ? rest.peak_in(period) : 0.5 * (times[first] + times[last]);
    const double width = std::max((wide ? wider : reach) * rest.distance, 0.5 * fewest_within * spacing);
    std::vector<double> places, heights;
    for (std::size_t i = 0; i < times.size(); ++i)
        if (std::abs(times[i] - middle) <= width) {
            places.push_back((times[i] - middle) / width);
            heights.push_back(values[i] - rest.value);
        }
    constexpr std::size_t fewest = 4;
    if (places.size() < fewest)
        return false;
    const LocalPolynomial fit(places, std::min(shape.degree, places.size() / 2));
    const std::vector<double> powers = fit.powers(heights.data());
    double x = 0;
    constexpr int steps = 50;
    for (int i = 0; i < steps; ++i) { // Newton's method for the zero of the slope
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
    double squares = 0;
    for (std::size_t k = 0; k <= fit.degree(); ++k)
        squares += fit.at_zero(k) * fit.at_zero(k);
    peak = {middle + width * x, middle, width, rest.noise * std::sqrt(squares), powers};
    // Compare the fitted envelope, not the peak itself, with the noise: else peaks that noise has raised would be
    // selected.
    constexpr double stands_out = 5;
    return std::abs(x) < 1 && rest.height_at(peak.time) > stands_out * peak.noise;
}

/// Evaluates all polynomials at equidistant times fitted to their maxima. At its own maximum each polynomial is too
/// high by an amount that grows as the peak becomes lower, since noise shifts that maximum.
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

/// Fits peaks until one does not stand out.
std::vector<PeakFit> fits_of(const std::vector<Period>& periods, std::size_t channel, const DecayFit& rest) {
    const auto fits_by = [&](std::size_t most, const auto& shape_at) {
        std::vector<PeakFit> fits;
        PeakFit fit;
        for (std::size_t k = 0; k < most && fit_peak(periods[k], channel, rest, shape_at(k), fit); ++k)
            fits.push_back(fit);
        return fits;
    };
    constexpr double width = 0.3; // of a period
    const double samples = width * static_cast<double>(periods.front().samples.rows());
    const auto height = [&](std::size_t k) { return rest.height_at(rest.peak_in(periods[k])); };
    const std::size_t count = fits_by(periods.size(), [&](std::size_t k) {
                                  return shape_of(height(k), height(k), rest.noise, samples);
                              }).size();
    if (count == 0)
        return {};
    const PeakShape shape = shape_of(height(0), height(count - 1), rest.noise, samples);
    return fits_by(count, [&](std::size_t) { return shape; });
}

/// Refuses a record with a gap so long that it may hide a period, as periods would be miscounted.
void require_no_gap(const std::vector<Period>& periods, const Samples& samples, const std::string& name) {
    std::vector<double> durations;
    for (const Period& one : periods)
        durations.push_back(one.end - one.begin);
    const double usual = median(std::move(durations));
    constexpr double much = 0.5;
    for (std::size_t i = 1; i < samples.rows(); ++i)
        if (const double from = samples.times[i - 1], to = samples.times[i];
            to - from > much * usual && to > periods.front().begin && from < periods.back().end)
            throw InputError(fmt::format("'{}' has no rows from {:.6g} to {:.6g}, for {:.2g} of its periods", name,
                                         from, to, (to - from) / usual),
                             fmt::format("give a part without gaps, as all from {:.6g} on", to));
}

} // namespace

DecayPeaks decay_peaks(SampleSource& source, std::size_t channel, std::size_t most) {
    const RecordHeader header = source.header();
    require_index(channel, header.channels.size(), "channel");
    const std::string& name = header.channels[channel].name;
    const Samples samples = read_all(source, most_samples_of_decay);
    if (samples.rows() == 0)
        throw InputError("the record has no rows", "give one with rows, or a larger part of it");
    const double level = level_of(samples.values[channel]);
    const std::vector<Period> periods = periods_of(samples, header, channel, level, most);
    if (periods.size() < 2)
        throw InputError(
            fmt::format("'{}' has {} (from one rise through {:.4g}, its mean over the second half, to the next) "
                        "that stands out from noise; two are needed",
                        name, periods.size() == 1 ? "one period" : "no period", level),
            "give the whole record of a decaying oscillation; damping may be too strong for this");
    require_no_gap(periods, samples, name);
    const std::optional<DecayFit> found = fit_damped_sine(periods, samples, channel, level);
    if (!found)
        throw InputError(fmt::format("'{}' is not a decaying oscillation", name),
                         "give the record of a single one, from its release on");
    const std::vector<PeakFit> fits = fits_of(periods, channel, *found);
    if (fits.size() < 2 && !found->wave.residual_test.is_noise())
        throw InputError(fmt::format("'{}' is not a damped sine: {}", name, found->wave.residual_test.text()),
                         "look at the record there, and give a part of it that is free of that");
    if (fits.size() < 2)
        throw InputError(fmt::format("{1} of {2} peaks of '{0}' stand out from the noise, which is {3:.2g} a sample",
                                     name, fits.size(), periods.size(), found->noise),
                         "filter out higher frequencies, or record a larger release");
    DecayPeaks peaks = at_common_times(fits);
    peaks.rest = found->value;
    peaks.rest_error = found->error * found->wave.residual_test.widening;
    peaks.wave = found->wave;
    return peaks;
}

} // namespace graze
