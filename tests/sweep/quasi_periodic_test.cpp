#include "settle.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace graze::quasi_periodic_test {

/// Returns numbers between 0 and 1 that are evenly spread.
double even_number(int k) {
    const double x = k * 0.6180339887498949;
    return x - std::floor(x);
}

std::string circle(double Omega, double K) {
    return fmt::format("z + {:.17g} - {:.17g}/(2*pi)*sin(2*pi*z)", Omega, K);
}

/// Returns the largest exponent of the circle map over many iterations: zero unless locked.
double exponent_of_circle(double Omega, double K) {
    double z = 0.2, sum = 0;
    constexpr int iterations = 100'000;
    for (int k = 0; k < iterations; ++k) {
        sum += std::log(std::abs(1 - K * std::cos(2 * std::numbers::pi * z)));
        z += Omega - K / (2 * std::numbers::pi) * std::sin(2 * std::numbers::pi * z);
        z -= std::floor(z);
    }
    return sum / iterations;
}

TEST(QuasiPeriodic, UnlockedCircleMapsAreLabelled) {
    int unlocked = 0, said = 0;
    for (int k = 1; k <= 60; ++k) {
        const double Omega = 0.05 + 0.9 * even_number(k), K = k % 2 == 0 ? 0.7 : 0.4;
        const double exponent = exponent_of_circle(Omega, K);
        const PointResult result = settle(iterated(circle(Omega, K), 0.2, true));
        if (exponent < -1e-3) {
            EXPECT_NE(result.label, Label::quasi_periodic) << Omega << " " << K;
        } else if (exponent > -1e-5) {
            ++unlocked;
            said += result.label == Label::quasi_periodic ? 1 : 0;
            EXPECT_TRUE(result.label == Label::quasi_periodic || result.label == Label::unsettled) << Omega;
            ASSERT_TRUE(result.lyapunov && result.lyapunov_error);
            EXPECT_LE(std::abs(*result.lyapunov), *result.lyapunov_error) << Omega;
        }
    }
    EXPECT_GE(unlocked, 30);
    EXPECT_GE(said, 0.8 * unlocked); // the others are next to tongues, where motions linger
}

TEST(QuasiPeriodic, ForcedVanDerPolOscillatorAwayFromResonanceIsLabelled) {
    int said = 0;
    for (int k = 0; k < 15; ++k) {
        const PointResult result =
            settle(oscillator("0.4*(1 - X^2)*V - X + 0.3*cos(theta)", SectionOf::clock, 0.5, 0, 1.35 + 0.05 * k));
        EXPECT_NE(result.label, Label::chaotic) << k;
        said += result.label == Label::quasi_periodic ? 1 : 0;
    }
    EXPECT_GE(said, 12);
}

TEST(QuasiPeriodic, ConservativeToriAreLabelled) {
    int said = 0;
    for (int k = 0; k < 10; ++k)
        said += settle(oscillator("-X - X^3", SectionOf::clock, 0.3 + 0.1 * k, 0)).label == Label::quasi_periodic;
    EXPECT_GE(said, 5); // neighbours separate linearly in time, which resembles weak chaos for long
}

TEST(QuasiPeriodic, WeakAndBandedChaosIsNotLabelled) {
    for (int k = 0; k < 120; ++k) {
        const double r = 3.6 + 0.4 * (k + 0.5) / 120;
        EXPECT_NE(settle(iterated(fmt::format("{:.17g}*z*(1 - z)", r), 0.2)).label, Label::quasi_periodic) << r;
    }
}

TEST(QuasiPeriodic, AWeaklyAttractingFocusIsNotLabelled) {
    // It shrinks by 1e-5 in a return, less than averages over a few hundred returns can show.
    const PointResult result = settle(oscillator("-3.2e-6*V - X", SectionOf::clock, 1e-3, 0, 1.3));
    EXPECT_EQ(result.label, Label::equilibrium);
}

TEST(QuasiPeriodic, GrowingMotionsAreNotLabelled) {
    // z -> 1.63 z + 1 grows below -1/0.63, to where 1 - 3.7 z has mapped it: with contacts in every return.
    const PointResult map = settle(in_two_pieces("1.63*z + 1", "-3.7*z + 1", 0, 0.21));
    EXPECT_EQ(map.label, Label::unbounded) << name_of(map.label);
    EXPECT_NE(settle(iterated("-1.05*z", 1)).label, Label::quasi_periodic);
}

} // namespace graze::quasi_periodic_test
