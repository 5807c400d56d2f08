#include "graze/identify/residual_test.hpp"

#include "graze/base/input_error.hpp"
#include "graze/identify/decrement.hpp"
#include "graze/identify/estimate.hpp"
#include "graze/identify/identification.hpp"
#include "identify/releases.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gmock/gmock.h>
#include <numbers>

namespace graze::testing::residual_test_test {

std::vector<double> series(std::size_t count, const std::function<double(double)>& value) {
    std::vector<double> result;
    for (std::size_t i = 0; i < count; ++i)
        result.push_back(value(static_cast<double>(i)));
    return result;
}

// An F variable with one and f degrees of freedom is the square of Student's t.
TEST(ResidualTest, FisherTailOfOneDegreeIsThatOfStudent) {
    for (const double freedom : {3.0, 10.0, 200.0})
        for (const double probability : {0.5, 0.95, 0.999}) {
            const double t = student_quantile(probability, freedom);
            EXPECT_NEAR(fisher_tail(t * t, 1, freedom), 1 - probability, 1e-10);
        }
}

TEST(ResidualTest, AcceptsRandomNoise) {
    std::size_t wrong = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        Noise noise(seed);
        wrong += test_residuals(series(30 + 5 * seed, [&](double) { return noise.normal(); })).is_noise() ? 0 : 1;
    }
    EXPECT_LE(wrong, 2U);
}

/// With a jittering clock the residuals decay with the motion, as the weights of the samples should.
TEST(ResidualTest, FindsNoiseThatDecays) {
    const std::vector<double> readings = series(400, [](double i) { return 1000 * std::sin(i); });
    std::size_t wrong = 0, seen = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        Noise noise(seed);
        wrong += test_residuals(series(400, [&](double) { return noise.normal(); }), readings).is_noise() ? 0 : 1;
        const ResidualTest dying =
            test_residuals(series(400, [&](double i) { return std::exp(-i / 400) * noise.normal(); }), readings);
        seen += dying.is_noise() ? 0 : 1;
        // Noise with heavy tails must not be mistaken for decaying noise.
        const auto tails = series(400, [&](double) { return noise.normal() / std::sqrt(0.05 + noise.uniform()); });
        EXPECT_EQ(test_residuals(tails, readings).text().find("as large in the first half"), std::string::npos) << seed;
    }
    EXPECT_LE(wrong, 1U);
    EXPECT_GE(seen, 85U);
}

/// A release whose samples are taken up to a tenth of a step off their times.
TEST(ResidualTest, FindsAClockThatJitters) {
    constexpr double w0 = 50, zeta = 0.02, step = 3e-3;
    std::size_t told = 0, wrong = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed)
        for (const double jitter : {0.0, 0.2}) {
            Noise noise(seed);
            const Wave wave = [&](double t) {
                const double late = step * jitter * (noise.uniform() - 0.5);
                return damped_cosine(w0, zeta, t + late, 0.3) + 0.002 * noise.normal();
            };
            const DecayPeaks peaks = peaks_in(sampled(1 / step, 1000, {wave}));
            (jitter > 0 ? told : wrong) += peaks.wave.residual_test.is_noise() ? 0 : 1;
        }
    EXPECT_GE(told, 38U);
    EXPECT_LE(wrong, 1U);
}

TEST(ResidualTest, NamesTheStructureThatItFinds) {
    Noise noise(3);
    const auto text = [&](const std::function<double(double)>& value) {
        return test_residuals(series(2000, [&](double i) { return value(i) + noise.normal(); })).text();
    };
    EXPECT_THAT(text([](double i) { return 0.4 * (i - 1000) / 1000; }), ::testing::HasSubstr("residuals drift"));
    EXPECT_THAT(text([](double i) { return 0.3 * std::sin(2 * std::acos(-1.0) * 123 * i / 2000); }),
                ::testing::HasSubstr("a wave of 123 cycles"));
    EXPECT_THAT(text([](double i) { return std::cos(2 * std::acos(-1.0) * 3 * i / 2000); }),
                ::testing::HasSubstr("keep their sign"));
    EXPECT_THAT(text([](double i) { return i == 700 ? 9.0 : 0.0; }), ::testing::HasSubstr("1 of 2000 readings"));
}

TEST(ResidualTest, CountsClippedReadings) {
    Noise noise(4);
    const auto wave = [&](double i) { return std::sin(0.01 * i) + 0.01 * noise.normal(); };
    EXPECT_EQ(clipped_readings(series(2000, wave)), 0U);
    EXPECT_EQ(clipped_readings(series(2000, [&](double i) { return std::round(100 * wave(i)) / 100; })), 0U);
    EXPECT_GT(clipped_readings(series(2000, [&](double i) { return std::min(0.8, wave(i)); })), 100U);
    EXPECT_GT(clipped_readings(series(2000, [&](double i) { return std::max(-0.9, std::round(100 * wave(i)) / 100); })),
              100U);
}

TEST(ResidualTest, ChanceOfFitIsUniformForRandomNoise) {
    std::size_t below = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        Noise noise(seed);
        const auto left = series(20, [&](double) { return noise.normal(); });
        below +=
            chance_of_fit(left, {series(20, [](double i) { return i; })},
                          {series(20, [](double) { return 1.0; }), series(20, [](double i) { return i * i; })}) < 0.1
                ? 1
                : 0;
    }
    EXPECT_NEAR(static_cast<double>(below), 100, 38); // four standard deviations of a binomial count
}

TEST(ResidualTest, RepeatedReadingsWidenErrors) {
    const auto rounded = [](double step) {
        const auto exact = series(400, [](double i) { return std::exp(-0.003 * i) * std::cos(0.21 * i + 0.3); });
        std::vector<double> readings, left;
        for (const double value : exact) {
            readings.push_back(std::round(value / step) * step);
            left.push_back(readings.back() - value);
        }
        return test_residuals(left, readings).widening;
    };
    EXPECT_GT(rounded(0.2), 1.3);
    EXPECT_NEAR(rounded(0.001), 1, 0.05);
}

// Rounded to steps of 0.2, without noise that would blur them: intervals that assume independent errors cover 85 %.
TEST(DampedOscillationSlow, IntervalsCoverTheTruthForCoarselyRoundedReadings) {
    constexpr double w0 = 20, zeta = 0.015, step = 0.2, pi = std::numbers::pi;
    std::size_t frequencies = 0, dampings = 0, answers = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        Noise noise(7000 + seed);
        const double phase = 1000 * noise.normal();
        const Wave wave = [&](double t) { return step * std::round(damped_cosine(w0, zeta, t, phase) / step); };
        const std::vector<DecayWave> waves{peaks_in(sampled(30 * w0 / (2 * pi), 400, {wave})).wave};
        const DampedOscillation found = damped_oscillation(waves);
        ++answers;
        frequencies += covers(found.frequency, w0) ? 1 : 0;
        dampings += covers(found.damping, zeta) ? 1 : 0;
    }
    EXPECT_GE(frequencies, 270U) << "285 +- 4 of " << answers;
    EXPECT_GE(dampings, 270U);
}

// Amplitude 0.35 sampled every 0.2 ms: with noise of 0.005 peaks alone gave 0.0175 instead of 0.017.
TEST(DampedOscillationSlow, IntervalsCoverTheTruthAtAnyNoise) {
    constexpr double w0 = 96.4;
    for (const double zeta : {0.005, 0.017, 0.08})
        for (const double sigma : {0.0005, 0.005, 0.02}) {
            std::size_t dampings = 0, frequencies = 0, doubted = 0;
            constexpr std::size_t tries = 60;
            for (std::uint64_t seed = 0; seed < tries; ++seed) {
                Noise noise(1000 + seed);
                const Wave wave = [&](double t) {
                    return 0.35 * damped_cosine(w0, zeta, t, -std::numbers::pi / 2) + sigma * noise.normal();
                };
                std::vector<DecayWave> waves;
                for (int release = 0; release < 2; ++release) {
                    waves.push_back(peaks_in(sampled(5000, 4000, {wave})).wave);
                    doubted += waves.back().residual_test.is_noise() ? 0 : 1;
                }
                const DampedOscillation found = damped_oscillation(waves);
                dampings += covers(found.damping, zeta) ? 1 : 0;
                frequencies += covers(found.frequency, w0) ? 1 : 0;
            }
            EXPECT_GE(dampings, 51U) << zeta << " " << sigma; // 57 +- 1.7
            EXPECT_GE(frequencies, 51U) << zeta << " " << sigma;
            EXPECT_LE(doubted, 1U) << zeta << " " << sigma;
        }
}

} // namespace graze::testing::residual_test_test
