#include "graze/results/spectrum.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace graze::testing {

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Samples of a mean and of waves with whole numbers of turns.
std::vector<double> waves(std::size_t count, double mean, const std::vector<std::pair<int, double>>& parts) {
    std::vector<double> samples(count, mean);
    for (std::size_t i = 0; i < count; ++i)
        for (const auto& [turns, amplitude] : parts)
            samples[i] += amplitude *
                          std::cos(2 * std::numbers::pi * turns * static_cast<double>(i) / static_cast<double>(count) +
                                   0.4 * turns);
    return samples;
}

} // namespace

TEST(SpectrumTest, FindsTheAmplitudesAtTheirFrequencies) {
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

TEST(SpectrumTest, CountsTheHighestFrequencyOnce) {
    const Spectrum parts = spectrum(std::vector<double>{4, 2, 4, 2, 4, 2}, 10);
    EXPECT_NEAR(parts.frequencies.back(), 5, 8 * eps);
    EXPECT_NEAR(parts.amplitudes.back(), 1, 64 * eps);
    EXPECT_NEAR(parts.mean, 3, 8 * eps);
}

// Parseval: the mean square of what is left without the mean is that of the waves.
TEST(SpectrumTest, KeepsTheMeanSquare) {
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

TEST(SpectrumTest, SeesNothingInConstantOrTooFewSamples) {
    for (const double amplitude : spectrum(std::vector<double>(8, 3.0), 1).amplitudes)
        EXPECT_EQ(amplitude, 0);
    EXPECT_TRUE(spectrum(std::vector<double>{1}, 1).frequencies.empty());
    EXPECT_TRUE(spectrum({}, 1).frequencies.empty());
}

} // namespace graze::testing
