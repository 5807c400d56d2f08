#include "graze/record/spectrum.hpp"

#include "graze/base/input_error.hpp"
#include "record/even_clock.hpp"
#include "record/waves.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <utility>

namespace graze::testing::spectrum_test {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Samples of a mean and waves with whole numbers of cycles.
std::vector<double> waves(std::size_t count, double mean, const std::vector<std::pair<int, double>>& parts) {
    std::vector<double> samples(count, mean);
    for (std::size_t i = 0; i < count; ++i)
        for (const auto& [turns, amplitude] : parts)
            samples[i] += amplitude *
                          std::cos(2 * std::numbers::pi * turns * static_cast<double>(i) / static_cast<double>(count) +
                                   0.4 * turns);
    return samples;
}

TEST(Spectrum, FindsAmplitudesAndFrequenciesOfWaves) {
    const Spectrum parts = spectrum(waves(60, 5, {{3, 0.25}, {20, 2}}), 6.25);
    EXPECT_NEAR(parts.mean, 5, 60 * 8 * eps);
    ASSERT_EQ(parts.frequencies.size(), 30U);
    ASSERT_EQ(parts.amplitudes.size(), 30U);
    for (std::size_t k = 1; k <= 30; ++k) {
        EXPECT_NEAR(parts.frequencies[k - 1], static_cast<double>(k) * 6.25 / 60, 8 * eps);
        // Sixty samples of up to 7.25, each rounded a few times.
        EXPECT_NEAR(parts.amplitudes[k - 1], k == 3 ? 0.25 : k == 20 ? 2 : 0, 60 * 8 * 8 * eps) << k;
    }
}

TEST(Spectrum, CountsTheHighestFrequencyOnce) {
    const Spectrum parts = spectrum(std::vector<double>{4, 2, 4, 2, 4, 2}, 10);
    EXPECT_NEAR(parts.frequencies.back(), 5, 8 * eps);
    EXPECT_NEAR(parts.amplitudes.back(), 1, 64 * eps);
    EXPECT_NEAR(parts.mean, 3, 8 * eps);
}

// Parseval: the variance of the samples is that of the waves.
TEST(Spectrum, KeepsTheMeanSquare) {
    std::vector<double> samples;
    double x = 0.3;
    for (int i = 0; i < 101; ++i)
        samples.push_back(x = 3.9 * x * (1 - x));
    const Spectrum parts = spectrum(samples, 1);
    double squares = 0, sum = 0;
    for (const double sample : samples)
        squares += (sample - parts.mean) * (sample - parts.mean) / 101;
    for (const double amplitude : parts.amplitudes)
        sum += amplitude * amplitude / 2;
    EXPECT_EQ(parts.amplitudes.size(), 50U);
    EXPECT_NEAR(sum, squares, 101 * 16 * eps);
}

TEST(Spectrum, IsZeroForConstantOrTooFewSamples) {
    for (const double amplitude : spectrum(std::vector<double>(8, 3.0), 1).amplitudes)
        EXPECT_EQ(amplitude, 0);
    EXPECT_TRUE(spectrum(std::vector<double>{1}, 1).frequencies.empty());
    EXPECT_TRUE(spectrum({}, 1).frequencies.empty());
}

// Lengths for Bluestein's algorithm, odd and prime ones too, powers of two, and lengths beyond the processor's cache.
TEST(Spectrum, EqualsTheDirectSumForManySamples) {
    for (const std::size_t count : {513U, 1009U, 1024U, 6000U, 20'011U, 32'768U}) {
        const Spectrum parts = spectrum(waves(count, 5, {{3, 0.25}, {200, 2}}), 6.25);
        ASSERT_EQ(parts.amplitudes.size(), count / 2);
        for (std::size_t k = 1; k <= parts.amplitudes.size(); ++k)
            EXPECT_NEAR(parts.amplitudes[k - 1], k == 3 ? 0.25 : k == 200 ? 2 : 0, 2e-13) << count << ' ' << k;
        EXPECT_NEAR(parts.frequencies[199], 200 * 6.25 / static_cast<double>(count), 1e-14 * 200);
    }
}

TEST(Spectrum, IsEmptyWhenItWasInterrupted) {
    for (const std::size_t count : {20'000U, 32'768U}) {
        const std::vector<double> samples = waves(count, 5, {{3, 0.25}});
        int asked = 0;
        const auto later = [&] { return ++asked == 2; };
        EXPECT_TRUE(spectrum(samples, 1, later).amplitudes.empty());
        EXPECT_EQ(asked, 2);
        EXPECT_EQ(spectrum(samples, 1, [] { return false; }).amplitudes, spectrum(samples, 1).amplitudes);
    }
    const auto make = [] {
        return StoredSamples(named({"v"}), sampled(1000, 10'000, {[](double) { return 1.0; }}), 777);
    };
    StoredSamples source = make(), again = make();
    int asked = 0;
    EXPECT_TRUE(averaged_spectrum(source, 0, 256, [&] { return ++asked == 3; }).amplitudes.empty());
    EXPECT_EQ(asked, 3);
    EXPECT_EQ(averaged_spectrum(again, 0, 256, [] { return false; }).amplitudes.size(), 128U);
}

TEST(Spectrum, AveragedOverALongRecordKeepsAmplitudesAndFrequencies) {
    const double pi = std::numbers::pi;
    const auto wave = [&](double t) { return 1 + 0.5 * std::cos(2 * pi * 125 * t) + 0.1 * std::sin(2 * pi * 250 * t); };
    StoredSamples source(named({"v"}), sampled(1000, 10'000, {wave}), 777);
    const Spectrum parts = averaged_spectrum(source, 0, 256);
    ASSERT_EQ(parts.amplitudes.size(), 128U);
    EXPECT_NEAR(parts.mean, 1, 1e-12);
    for (std::size_t k = 1; k <= 128; ++k) {
        EXPECT_NEAR(parts.frequencies[k - 1], 1000.0 * static_cast<double>(k) / 256, 1e-9);
        // Hann's window puts half of an amplitude into each neighbouring line.
        const double expected = k == 32              ? 0.5
                                : k == 31 || k == 33 ? 0.25
                                : k == 64            ? 0.1
                                : k == 63 || k == 65 ? 0.05
                                                     : 0;
        EXPECT_NEAR(parts.amplitudes[k - 1], expected, 1e-12) << k;
    }
    EXPECT_THROW(averaged_spectrum(source, 0, 4), InputError);
    EXPECT_THROW(averaged_spectrum(source, 0, 256), InputError) << "nothing is left of it";
}

TEST(Spectrum, RefusesSamplesThatAreNotEquidistant) {
    EXPECT_NEAR(sampling_frequency(std::vector<double>{0, 0.1, 0.21, 0.3}), 10, 1e-12);
    EXPECT_THROW(sampling_frequency(std::vector<double>{0, 0.1, 0.3, 0.4}), InputError);
    EXPECT_THROW(sampling_frequency(std::vector<double>{0}), InputError);
    std::vector<double> times{0}, written, jittered;
    for (int i = 1; i < 1000; ++i)
        times.push_back(times.back() + (i < 500 ? 1e-3 : 1.002e-3));
    EXPECT_NEAR(sampling_frequency(times), 1e3, 2);
    EXPECT_THROW(even_sampling_frequency(times), InputError) << "its waves are at other frequencies";
    for (int i = 0; i < 1000; ++i) {
        written.push_back(std::round(i / 0.3) / 1000);
        jittered.push_back(1e-3 * (i + 0.03 * std::sin(i * i)));
    }
    EXPECT_NEAR(even_sampling_frequency(written), 300, 0.1) << "rounded to ms";
    EXPECT_NEAR(even_sampling_frequency(jittered), 1e3, 0.1) << "by less than a twentieth of a step";
}

} // namespace graze::testing::spectrum_test
