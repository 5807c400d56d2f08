#include "graze/identify/decrement.hpp"

#include "base/message_of.hpp"
#include "graze/base/input_error.hpp"
#include "identify/releases.hpp"

#include <gmock/gmock.h>
#include <numbers>
#include <string>

namespace graze::testing::decrement_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Constants of the testbed: Appendix C of B. E. Wilcox's dissertation.
constexpr double frequency = 95.94, damping = 0.01626;

/// Velocity after a release from a displacement at time 0.
double velocity(double t, double displacement) {
    const double damped = frequency * std::sqrt(1 - damping * damping);
    return -displacement * frequency * frequency / damped * std::exp(-damping * frequency * t) * std::sin(damped * t);
}

DecayPeaks peaks_of(Noise& noise, double sigma, double rest = 0) {
    constexpr double rate = 1000;
    const double begin = 0.001 * noise.uniform();
    const auto clock = [&](std::size_t i) { return begin + static_cast<double>(i) / rate; };
    const Wave wave = [&](double t) { return rest + velocity(t, 0.762e-3) + sigma * noise.normal(); };
    return peaks_in(sampled_at(clock, static_cast<std::size_t>(rate), {wave}));
}

/// Peaks of several releases at 1 kHz.
std::vector<DecayPeaks> releases_of(Noise& noise, int count, double sigma, double rest = 0) {
    std::vector<DecayPeaks> releases;
    for (int r = 0; r < count; ++r)
        releases.push_back(peaks_of(noise, sigma, rest));
    return releases;
}

TEST(Decrement, IsExactForExactPeaks) {
    const double damped = frequency * std::sqrt(1 - damping * damping), period = 2 * std::numbers::pi / damped;
    std::vector<DecayPeaks> releases(3);
    for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 10; ++k) {
            releases[static_cast<std::size_t>(r)].times.push_back(0.1 * r + k * period);
            releases[static_cast<std::size_t>(r)].heights.push_back((1 + r) *
                                                                    std::exp(-damping * frequency * k * period));
        }
    const Decrement found = logarithmic_decrement(releases);
    EXPECT_NEAR(found.frequency.value, frequency, 1e-12 * frequency);
    EXPECT_NEAR(found.damping.value, damping, 1e-12);
    EXPECT_NEAR(found.pair_frequency, frequency, 1e-12 * frequency);
    EXPECT_NEAR(found.pair_damping, damping, 1e-12);
    EXPECT_LT(found.frequency.error, 1e-11);
    EXPECT_EQ(found.frequency.freedom, 26);
}

TEST(Decrement, HasNineDigitsWithoutNoise) {
    Noise noise(1);
    const std::vector<DecayPeaks> releases = releases_of(noise, 10, 0);
    const Decrement found = logarithmic_decrement(releases);
    EXPECT_EQ(releases[0].times.size(), 10U);
    EXPECT_NEAR(found.frequency.value, frequency, 1e-9 * frequency);
    EXPECT_NEAR(found.damping.value, damping, 1e-9);
}

// Ten releases with ten peaks each, at 1 kHz, as in section 5.3.1.
TEST(Decrement, IntervalsCoverTheTruth) {
    std::size_t frequencies = 0, dampings = 0;
    double scatter = 0, pairs = 0;
    for (std::size_t seed = 0; seed < experiments; ++seed) {
        Noise noise(seed);
        const Decrement found = logarithmic_decrement(releases_of(noise, 10, 5e-4));
        frequencies += covers(found.frequency, frequency) ? 1 : 0;
        dampings += covers(found.damping, damping) ? 1 : 0;
        scatter += std::pow(found.damping.value - damping, 2);
        pairs += std::pow(found.pair_damping - damping, 2);
    }
    expect_coverage(frequencies, "natural frequency");
    expect_coverage(dampings, "damping ratio");
    EXPECT_LT(scatter, pairs) << "means of pairs have larger errors";
}

// Few samples a period, at any phase.
TEST(Decrement, IsFoundWithFewSamplesAPeriod) {
    const double damped = frequency * std::sqrt(1 - damping * damping);
    for (const double in_a_period : {6.3, 8.0, 9.3, 11.0, 12.0, 13.0})
        for (const double relative : {0.0, 1e-3, 1e-2}) {
            std::size_t frequencies = 0, dampings = 0;
            constexpr std::size_t phases = 40;
            for (std::size_t k = 0; k < phases; ++k) {
                Noise noise(k);
                const auto clock = [&](std::size_t i) {
                    return static_cast<double>(i) * 2 * std::numbers::pi / (damped * in_a_period);
                };
                const Wave wave = [&](double t) {
                    return 0.05 + damped_cosine(frequency, damping, t, 0.157 * static_cast<double>(k)) +
                           relative * noise.normal();
                };
                const auto count = static_cast<std::size_t>(std::ceil(12.5 * in_a_period));
                const DecayPeaks peaks = peaks_in(sampled_at(clock, count, {wave}));
                EXPECT_GE(peaks.times.size(), 3U) << in_a_period << ' ' << k;
                EXPECT_TRUE(peaks.wave.residual_test.is_noise()) << peaks.wave.residual_test.text();
                const DampedOscillation found = damped_oscillation({&peaks.wave, 1});
                const double roundoff = 1e-10;
                frequencies += covers(found.frequency, frequency, roundoff * frequency) ? 1 : 0;
                dampings += covers(found.damping, damping, roundoff) ? 1 : 0;
            }
            EXPECT_GE(frequencies, 34U) << in_a_period << ' ' << relative; // 38 +- 1.4 where there is noise
            EXPECT_GE(dampings, 33U) << in_a_period << ' ' << relative;
        }
}

// An outlier makes all peaks small relative to the residuals: the message must name the outlier.
TEST(Decrement, RefusesARecordWithAnOutlier) {
    Noise noise(3);
    Samples samples = sampled(1000, 500, {[&](double t) { return velocity(t, 0.762e-3) + 1e-4 * noise.normal(); }});
    samples.values[0][150] += 30;
    EXPECT_THAT(message_of([&] { peaks_in(samples); }),
                AllOf(HasSubstr("1 of "), HasSubstr("standard deviations off")));
}

// Periods cannot be counted if a whole one is missing; a gap of a few rows is harmless.
TEST(Decrement, RefusesAGapThatMayHideAPeriod) {
    for (const double length : {0.005, 0.07}) {
        Noise noise(3);
        Samples samples;
        samples.clear(1);
        for (int i = 0; i < 800; ++i) {
            const double t = 0.001 * i;
            if (t > 0.2 && t < 0.2 + length)
                continue;
            samples.times.push_back(t);
            samples.values[0].push_back(velocity(t, 0.762e-3) + 1e-4 * noise.normal());
        }
        std::string told;
        try {
            const DecayPeaks peaks = peaks_in(std::move(samples));
            const DampedOscillation found = damped_oscillation({&peaks.wave, 1});
            EXPECT_NEAR(found.frequency.value, frequency, 4 * found.frequency.error);
        } catch (const InputError& error) {
            told = error.what();
        }
        EXPECT_EQ(told.find("'v' has no rows from 0.2 to 0.27, for 1.1 of its periods; give a part without gaps") ==
                      std::string::npos,
                  length < 0.01)
            << told;
    }
}

// An unknown rest position other than zero is estimated, and its error enters the others.
TEST(Decrement, FindsTheRestPosition) {
    constexpr double rest = 0.3; // four times the first peak
    std::size_t dampings = 0, rests = 0;
    for (std::size_t seed = 0; seed < experiments; ++seed) {
        Noise noise(seed);
        const std::vector<DecayPeaks> releases = releases_of(noise, 3, 2e-3, rest);
        const Decrement found = logarithmic_decrement(releases);
        dampings += covers(found.damping, damping) ? 1 : 0;
        rests += std::abs(releases[0].rest - rest) < 1.96 * releases[0].rest_error ? 1 : 0;
    }
    expect_coverage(dampings, "damping ratio");
    expect_coverage(rests, "rest position");
    Noise none(1);
    const DecayPeaks exact = peaks_of(none, 0, rest);
    EXPECT_NEAR(exact.rest, rest, 1e-12);
}

// With noise of a third of the first peak only the first peaks stand out.
TEST(Decrement, UsesThePeaksThatStandOutFromNoise) {
    std::size_t frequencies = 0;
    for (std::size_t seed = 0; seed < experiments; ++seed) {
        Noise noise(seed);
        const Decrement found = logarithmic_decrement(releases_of(noise, 4, 0.02));
        frequencies += covers(found.frequency, frequency) ? 1 : 0;
        EXPECT_NEAR(found.damping.value, damping, 5 * found.damping.error) << seed;
    }
    expect_coverage(frequencies, "natural frequency");
    Noise noise(3);
    const std::string told = message_of([&] { peaks_of(noise, 0.3); });
    EXPECT_NE(told, "") << "noise of four times the first peak";
    EXPECT_THAT(told, Not(HasSubstr("about nought")));
}

// With the strongest damping each peak is less than a thirtieth of the one before, far below a tenth of the range.
// Without noise the error is that of the polynomials, and of the rest position.
TEST(Decrement, FindsStrongDamping) {
    for (const double zeta : {0.1, 0.2, 0.3, 0.5}) {
        constexpr double omega = 3, length = 20;
        constexpr std::size_t rows = 3000;
        const Wave wave = [&](double t) { return damped_cosine(omega, zeta, t, std::numbers::pi / 2); };
        const Decrement found = logarithmic_decrement(std::vector{peaks_in(sampled(rows / length, rows, {wave}))});
        EXPECT_NEAR(found.frequency.value, omega, 1e-8) << zeta;
        EXPECT_NEAR(found.damping.value, zeta, 1e-9) << zeta;
    }
}

TEST(Decrement, RefusesInvalidPeaks) {
    StoredSamples empty({{"t", "s"}, {{"v", ""}}}, {{}, {{}}});
    EXPECT_THROW(decay_peaks(empty, 0, 10), InputError);
    const auto refused = [](const std::vector<DecayPeaks>& releases) {
        EXPECT_THROW(logarithmic_decrement(releases), InputError);
    };
    refused({});
    refused({{{0, 1}, {2, 1}}});
    refused({{{0, 1, 2}, {2, 1, -1}}});
    refused({{{0, 1, 1}, {3, 2, 1}}});
    refused({{{0, 1, 2}, {3, 2}}});
    refused({{{0, 1, 2}, {3, 2, std::nan("")}}});
    StoredSamples flat({{"t", "s"}, {{"v", ""}}}, {{0, 1, 2}, {{1, 1, 1}}});
    EXPECT_THROW(decay_peaks(flat, 0, 10), InputError);
    EXPECT_THROW(decay_peaks(flat, 1, 10), InputError);
}

} // namespace graze::testing::decrement_test
