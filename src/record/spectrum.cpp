#include "graze/record/spectrum.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "record/even_clock.hpp"
#include "record/fourier.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace graze {

namespace {

/// Direct sum with exact angles, for few samples.
std::complex<double> direct_sum(std::span<const double> samples, double mean, std::size_t k) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        // The product of the indices modulo N keeps the angle exact.
        const double turn = static_cast<double>((k * i) % samples.size()) / static_cast<double>(samples.size());
        sum += (samples[i] - mean) * std::polar(1.0, -2 * std::numbers::pi * turn);
    }
    return sum;
}

double mean_of(std::span<const double> samples) {
    return std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
}

std::vector<double> hann_window(std::size_t size) {
    std::vector<double> window(size);
    for (std::size_t i = 0; i < size; ++i)
        window[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(size));
    return window;
}

} // namespace

Spectrum spectrum(std::span<const double> samples, double frequency, const std::function<bool()>& interrupted) {
    require_finite(samples, "a sample");
    if (!(frequency > 0))
        throw InputError(fmt::format("the frequency {} of samples is not positive", frequency),
                         "give samples in a unit of time");
    require_finite(frequency, "the frequency of samples");
    Spectrum result;
    const std::size_t count = samples.size();
    if (count < 2)
        return result;
    const auto size = static_cast<double>(count);
    result.mean = mean_of(samples);
    constexpr std::size_t few = 512;
    std::vector<std::complex<double>> sums;
    if (count > few) {
        std::vector<double> rest(samples.begin(), samples.end());
        for (double& value : rest)
            value -= result.mean;
        sums = half_transform(rest, interrupted);
        if (sums.empty())
            return {};
    }
    for (std::size_t k = 1; 2 * k <= count; ++k) {
        const std::complex<double> sum = count > few ? sums[k] : direct_sum(samples, result.mean, k);
        result.frequencies.push_back(static_cast<double>(k) * frequency / size);
        result.amplitudes.push_back((2 * k == count ? 1 : 2) * std::abs(sum) / size);
    }
    return result;
}

double sampling_frequency(std::span<const double> times) {
    if (times.size() < 2)
        throw InputError("there are too few samples to determine the sampling frequency", "give two or more");
    const double spacing = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    constexpr double most = 0.25; // times are often written with few digits
    for (std::size_t i = 1; i < times.size(); ++i)
        if (!(std::abs(times[i] - times[i - 1] - spacing) <= most * spacing))
            throw InputError(fmt::format("the samples are not equidistant in time: between {} and {} there are "
                                         "{} instead of {}",
                                         times[i - 1], times[i], times[i] - times[i - 1], spacing),
                             "give a part of the record without gaps");
    return 1 / spacing;
}

Spectrum averaged_spectrum(SampleSource& source, std::size_t channel, std::size_t part,
                           const std::function<bool()>& interrupted) {
    require_index(channel, source.header().channels.size(), "channel");
    constexpr std::size_t least = 8;
    if (part < least)
        throw InputError(fmt::format("{} samples are too few for a spectrum", part), "take 8 or more");
    std::vector<double> window, piece; // sized only once there are that many samples, as `part` may be any number
    double weight = 0;
    Spectrum result;
    Samples buffer, more;
    buffer.clear(source.header().channels.size());
    std::size_t parts = 0;
    double duration = 0;
    while (source.read(more)) {
        buffer.append(more);
        if (window.empty() && part <= buffer.rows()) {
            window = hann_window(part);
            weight = mean_of(window);
            piece.resize(part);
        }
        std::size_t first = 0;
        for (; first + part <= buffer.rows(); first += part / 2, ++parts) {
            const std::span<const double> values(buffer.values[channel].data() + first, part);
            duration += static_cast<double>(part) /
                        even_sampling_frequency(std::span<const double>(buffer.times.data() + first, part));
            const double mean = mean_of(values);
            for (std::size_t i = 0; i < part; ++i)
                piece[i] = window[i] * (values[i] - mean);
            const std::vector<std::complex<double>> sums = half_transform(piece, interrupted);
            if (sums.empty())
                return {};
            result.amplitudes.resize(part / 2, 0.0);
            for (std::size_t k = 1; 2 * k <= part; ++k)
                result.amplitudes[k - 1] +=
                    std::pow((2 * k == part ? 1 : 2) * std::abs(sums[k]) / (weight * static_cast<double>(part)), 2);
            result.mean += mean;
        }
        buffer.drop_front(first);
    }
    if (parts == 0)
        throw InputError(fmt::format("the record has fewer than {} samples", part), "take a smaller part");
    const auto count = static_cast<double>(parts);
    result.mean /= count;
    for (std::size_t k = 1; k <= result.amplitudes.size(); ++k) {
        result.frequencies.push_back(static_cast<double>(k) * count / duration);
        result.amplitudes[k - 1] = std::sqrt(result.amplitudes[k - 1] / count);
    }
    return result;
}

} // namespace graze
