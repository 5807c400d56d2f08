#include "graze/identify/decrement.hpp"

#include "graze/symbolic/input_error.hpp"
#include "identify/noise.hpp"

#include <numbers>

namespace graze::testing {

namespace {

// Of the testbed: Appendix C of B. E. Wilcox's dissertation.
constexpr double frequency = 95.94, damping = 0.01626;

/// Velocity of a release at time 0 from a displacement.
double velocity(double t, double displacement) {
    const double damped = frequency * std::sqrt(1 - damping * damping);
    return -displacement * frequency * frequency / damped * std::exp(-damping * frequency * t) * std::sin(damped * t);
}

DecayPeaks peaks_of(Noise& noise, double sigma, double rate, std::size_t most = 10) {
    Samples samples;
    samples.clear(1);
    const double begin = 0.001 * noise.uniform();
    for (int i = 0; i < static_cast<int>(rate); ++i) {
        samples.times.push_back(begin + i / rate);
        samples.values[0].push_back(velocity(samples.times.back(), 0.762e-3) + sigma * noise.normal());
    }
    StoredSamples source({{"t", "s"}, {{"v", "m/s"}}}, std::move(samples));
    return decay_peaks(source, 0, most);
}

} // namespace

TEST(Decrement, OfExactPeaksIsExact) {
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

TEST(Decrement, OfSamplesWithoutNoiseIsRightToNineDigits) {
    Noise noise(1);
    std::vector<DecayPeaks> releases;
    for (int r = 0; r < 10; ++r)
        releases.push_back(peaks_of(noise, 0, 1000));
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
        std::vector<DecayPeaks> releases;
        for (int r = 0; r < 10; ++r)
            releases.push_back(peaks_of(noise, 5e-4, 1000));
        const Decrement found = logarithmic_decrement(releases);
        frequencies += std::abs(found.frequency.value - frequency) < found.frequency.half_width() ? 1 : 0;
        dampings += std::abs(found.damping.value - damping) < found.damping.half_width() ? 1 : 0;
        scatter += std::pow(found.damping.value - damping, 2);
        pairs += std::pow(found.pair_damping - damping, 2);
    }
    expect_coverage(frequencies, "natural frequency");
    expect_coverage(dampings, "damping ratio");
    EXPECT_LT(scatter, pairs) << "means of pairs waste what was measured";
}

TEST(Decrement, RefusesWhatIsNone) {
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

} // namespace graze::testing
