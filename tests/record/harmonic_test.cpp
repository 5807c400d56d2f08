#include "graze/record/harmonic.hpp"

#include "graze/base/input_error.hpp"
#include "record/waves.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace graze::testing::harmonic_test {

constexpr double turn = 2 * std::numbers::pi;

TEST(Harmonic, FindsTheCoefficientsOfASine) {
    const double w = turn * 6.1;
    const Samples wave = sampled(1000, 777,
                                 {[&](double t) { return 0.4 + 1.7 * std::sin(w * t + 2.5); },
                                  [&](double t) { return 1e-6 * std::sin(w * t - 0.1); }});
    const Harmonic fit = fit_harmonic(wave.times, wave.values[0], w);
    EXPECT_NEAR(fit.offset, 0.4, 1e-13);
    EXPECT_NEAR(fit.amplitude(), 1.7, 1e-13);
    EXPECT_NEAR(fit.phase(), 2.5, 1e-13);
    EXPECT_LT(fit.noise, 1e-13);
    const std::array<std::span<const double>, 2> channels{wave.values[0], wave.values[1]};
    EXPECT_NEAR(fit_frequency(wave.times, channels, w * 1.01), w, 1e-11 * w);
    EXPECT_THROW(fit_harmonic(std::vector<double>{1, 2, 3}, std::vector<double>{1, 2, 3}, 1), InputError);
    EXPECT_THROW(fit_harmonic(wave.times, wave.values[0], 1e-6), InputError);
    EXPECT_THROW(fit_harmonic(wave.times, wave.values[0], -1), InputError);
}

TEST(Harmonic, ErrorsFollowFromTheNoise) {
    const double w = turn * 3, sigma = 0.2;
    std::size_t amplitudes = 0, phases = 0, trials = 200;
    for (std::size_t seed = 0; seed < trials; ++seed) {
        Noise noise(seed);
        const Samples wave =
            sampled(200, 150, {[&](double t) { return std::sin(w * t + 1) + sigma * noise.normal(); }});
        const Harmonic fit = fit_harmonic(wave.times, wave.values[0], w);
        amplitudes += std::abs(fit.amplitude() - 1) < 1.96 * fit.amplitude_error() ? 1 : 0;
        phases += std::abs(fit.phase() - 1) < 1.96 * fit.phase_error() ? 1 : 0;
    }
    for (const std::size_t within : {amplitudes, phases}) { // expected: 190 +- 3
        EXPECT_GE(within, 180U);
        EXPECT_LE(within, 199U);
    }
}

} // namespace graze::testing::harmonic_test
