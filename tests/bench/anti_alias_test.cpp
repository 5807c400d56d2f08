#include "bench/anti_alias.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace graze::anti_alias_test {

/// Gain of the filter for a wave, in the steady state.
double gain(double corner, double frequency) {
    AntiAlias filter(corner);
    double sine = 0, cosine = 0;
    constexpr int settled = 4000, taken = 100'000;
    for (int i = 0; i < settled + taken; ++i) {
        const double phase = 2 * std::numbers::pi * frequency * i, value = filter.filtered(std::sin(phase));
        if (i >= settled) {
            sine += value * std::sin(phase);
            cosine += value * std::cos(phase);
        }
    }
    return 2 * std::hypot(sine, cosine) / taken;
}

TEST(AntiAlias, HasTheGainOfAButterworthFilter) {
    // |H|^2 = 1/(1 + (tan(pi f)/tan(pi f_c))^8); the samples hold whole periods, so only round-off remains.
    for (const double corner : {0.01, 0.05, 0.2})
        for (const double frequency : {0.002, 0.01, 0.05, 0.2, 0.4}) {
            const double ratio = std::tan(std::numbers::pi * frequency) / std::tan(std::numbers::pi * corner);
            EXPECT_NEAR(gain(corner, frequency), 1 / std::sqrt(1 + std::pow(ratio, 8)), 1e-9) << corner << frequency;
        }
}

TEST(AntiAlias, SettlesAtAGivenValue) {
    AntiAlias filter(0.05);
    filter.settle(3.5);
    for (int i = 0; i < 10; ++i)
        EXPECT_NEAR(filter.filtered(3.5), 3.5, 1e-12);
}

} // namespace graze::anti_alias_test
